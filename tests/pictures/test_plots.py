"""What simulations gave, drawn: by the lines, labels and points on the axes."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from fabric_cad.pictures import Outline
from fabric_cad.pictures.plots import (
    plot_crushing,
    plot_shear_curve,
    plot_tension_curves,
    plot_tension_surface,
    save_figure,
)
from fabric_cad.weave.bodies import Body

RATIOS = (0.0, 0.5, 1.0, 2.0, np.inf)


def tension():
    """A symmetric law on curves of constant k, and on a grid (k NaN)."""
    rows = [(np.nan, a, b) for a in np.linspace(0, 0.004, 4) for b in np.linspace(0, 0.004, 4)]
    for k in RATIOS:
        for s in np.linspace(0.004, 0.0, 6)[
            :-1
        ]:  # the grid has rest; not in the order in which they are drawn
            rows.append((k, 0.0, s) if np.isinf(k) else (k, s / max(k, 1), s * min(k, 1)))
    k, e11, e22 = np.array(rows).T
    law = [2e4 * a * (1 + 100 * a + 50 * b) for a, b in ((e11, e22), (e22, e11))]
    return {
        "k": k.tolist(),
        "E11": e11.tolist(),
        "E22": e22.tolist(),
        "T11": law[0].tolist(),
        "T22": law[1].tolist(),
    }


def shear(depth=0.002):
    angle = np.arange(0.0, 11.0)
    return {
        "angle_deg": angle,
        "moment_N_mm": angle**2,
        "force_N_per_mm": angle**2 / 80,
        "penetration_mm": depth * angle,
    }


def test_a_curve_for_every_ratio_in_per_cent_and_ascending():
    columns = tension()
    (axes,) = plot_tension_curves(columns).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("strain E11, %", "tension T11, N per yarn")
    labels = [line.get_label() for line in axes.lines]
    assert labels == ["k = 0", "k = 0.5", "k = 1", "k = 2", "k = ∞, T22 against E22"]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == labels
    for line, k in zip(axes.lines, RATIOS):
        x, y = line.get_data()
        assert len(x) == 6 and (np.diff(x) > 0).all() and (np.diff(y) > 0).all()
        assert x[-1] == pytest.approx(0.4 / max(k, 1) if np.isfinite(k) else 0.4)
    # the law is symmetric: what is drawn for k = inf is the curve of k = 0
    assert axes.lines[-1].get_ydata() == pytest.approx(axes.lines[0].get_ydata())
    assert len({line.get_color() for line in axes.lines}) == len(RATIOS)


def test_surfaces_hold_every_point_once():
    columns = tension()
    first, second = plot_tension_surface(columns).axes
    points = {(round(a, 9), round(b, 9)) for a, b in zip(columns["E11"], columns["E22"])}
    for axes, name in ((first, "T11"), (second, "T22")):
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("strain E11, %", "strain E22, %")
        assert axes.get_zlabel() == f"{name}, N per yarn"
        x, y, z = axes.lines[0].get_data_3d()
        assert len(x) == len(points) and max(z) == pytest.approx(max(columns[name]))
        assert max(x) == max(y) == pytest.approx(0.4)
        assert len(axes.collections) == 1
    line = {name: values[-5:] for name, values in columns.items()}
    with pytest.raises(ValueError, match="on one line"):
        plot_tension_surface(line)


def test_shear_is_one_curve_read_off_as_moment_and_as_force():
    columns = shear()
    (axes,) = plot_shear_curve(columns, allowed=0.011).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == (
        "shear angle, degrees",
        "moment of a cell, N mm",
    )
    assert axes.lines[0].get_ydata() == pytest.approx(columns["moment_N_mm"])
    (right,) = axes.child_axes
    assert right.get_ylabel() == "force along a side, N/mm"
    axes.figure.draw_without_rendering()
    assert np.array(right.get_ylim()) == pytest.approx(np.array(axes.get_ylim()) / 80)
    with pytest.raises(ValueError, match="no fixed ratio"):
        plot_shear_curve(columns | {"force_N_per_mm": columns["angle_deg"]})


def test_shear_shows_the_angle_at_which_contact_ceases_to_be_valid():
    (axes,) = plot_shear_curve(shear(), allowed=0.011).axes
    assert axes.lines[1].get_xdata() == pytest.approx([5.5, 5.5])
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "penetration 0.011 mm, 5.5°"
    ]
    (axes,) = plot_shear_curve(shear(depth=0.0)).axes
    assert len(axes.lines) == 1 and axes.get_legend() is None


def test_cuts_show_displacements_larger_over_the_cell_at_rest():
    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0], [0.0, 0.0]])
    cuts = {
        name: [Outline(Body.named(name), square, square * [1.0, 0.9])]
        for name in ("weft_1", "warp_1")
    }
    first, second = plot_crushing(cuts, 5.0).axes
    assert (first.get_xlabel(), second.get_xlabel()) == ("x mm", "y mm")
    assert "\u00d7 5" in first.get_title("right") and first.get_title("left") == "along weft 1"
    for axes in (first, second):
        assert axes.lines[0].get_xydata() == pytest.approx(square)
        assert axes.patches[0].get_xy()[:5] == pytest.approx(square * [1.0, 0.5])


def test_a_figure_is_saved_as_png_and_pdf_the_same_every_time(tmp_path):
    content = []
    for name in ("a", "b"):
        save_figure(plot_tension_curves(tension()), tmp_path / f"{name}.png", "plain: tension")
        files = [tmp_path / f"{name}.png", tmp_path / f"{name}.pdf"]
        content.append([file.read_bytes() for file in files])
    assert content[0] == content[1]
    png, pdf = content[0]
    assert png[:4] == b"\x89PNG" and pdf[:4] == b"%PDF" and b"CreationDate" not in pdf


def test_figures_are_those_of_the_axes_given():
    figure = Figure()
    assert plot_tension_curves(tension(), figure.subplots()) is figure
    figure = Figure()
    assert (
        plot_tension_surface(tension(), figure.subplots(1, 2, subplot_kw={"projection": "3d"}))
        is figure
    )
    figure = Figure()
    assert plot_shear_curve(shear(), figure.subplots()) is figure
