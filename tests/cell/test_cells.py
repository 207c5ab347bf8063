"""Every row shipped, from its table to its files, each file opened again by something else."""

import hashlib
import json
import shutil
import subprocess
import sys
from dataclasses import asdict
from datetime import datetime

import meshio
import numpy as np
import pytest
from fabrics import section_area
from PIL import Image

import fabric_cad
from fabric_cad import mesh_options
from fabric_cad.cell.pipeline import find_row, make_cell
from fabric_cad.cell.traces import renew_digests
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.meshing.count import hexahedra
from fabric_cad.model.solved import read_solved
from fabric_cad.support.staging import staged
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.edges import allowed_scaled_jacobian
from fabric_cad.yarn.planes import contact_patches
from fabric_cad.yarn.swept import SweptYarn, swept_yarns

ROWS = [name for table in read_families(shipped_families()).values() for name in table.names]


class Made:
    """One row's folder and what is in it."""

    def __init__(self, name, out):
        self.name, self.folder = name, out / name
        row, _ = find_row(shipped_families(), name)
        self.report = make_cell(row, out)
        self.fabric = read_solved(self.folder / "solved.csv")

    def file(self, kind):
        return self.folder / f"{self.name}.{kind}"


@pytest.fixture(scope="module", params=ROWS)
def made(request, tmp_path_factory):
    return Made(request.param, tmp_path_factory.mktemp("cells"))


@pytest.fixture(scope="module")
def twill32(tmp_path_factory):
    return Made("twill32", tmp_path_factory.mktemp("twill32"))


def test_every_file_is_there(made):
    assert {file.name for file in made.folder.iterdir()} == {
        *(f"{made.name}.{kind}" for kind in ("step", "msh", "inp", "vtu", "png")),
        "solved.csv",
        "report.json",
    }
    assert json.loads((made.folder / "report.json").read_text()) == made.report
    assert [file.name for file in made.folder.parent.iterdir()] == [made.name]


def test_the_report_says_where_it_comes_from(made):
    """Version, date with its zone, the options used, the row as read, and a digest of every file beside it."""
    report = made.report
    assert report["version"] == fabric_cad.__version__
    assert datetime.fromisoformat(report["date"]).tzinfo is not None
    assert report["options"] == asdict(mesh_options(made.fabric))
    row, _ = find_row(shipped_families(), made.name)
    given = {name: values[0] for name, values in row.measured.items() if not np.isnan(values[0])}
    assert (
        report["measured"].items()
        >= (given | {"name": made.name, "source": row.sources[0]}).items()
    )
    files = {path.name: path for path in made.folder.iterdir() if path.name != "report.json"}
    assert report["files"] == {
        name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in files.items()
    }


def test_digests_follow_what_comes_to_the_folder_later(twill32):
    before = json.loads((twill32.folder / "report.json").read_text())
    with staged(twill32.folder, renew_digests) as folder:
        (folder / "tension.csv").write_text("k")
    after = json.loads((twill32.folder / "report.json").read_text())
    assert after["files"] == before["files"] | {"tension.csv": hashlib.sha256(b"k").hexdigest()}
    assert before | {"files": 0} == after | {"files": 0}
    (twill32.folder / "tension.csv").unlink()
    (twill32.folder / "report.json").write_text(json.dumps(before))


def test_the_hexahedra_were_foretold(made):
    assert hexahedra(made.fabric, mesh_options(made.fabric)) == made.report["mesh"]["hexahedra"]


def test_yarns_touch_and_do_not_penetrate(made):
    found = made.report["consistency"]
    assert found["max_penetration_mm"] <= 1e-9
    assert found["max_contact_gap_mm"] <= 1e-9
    assert found["overlap_volume_mm3"] <= 1e-9
    assert found["thickness_mm"] == pytest.approx(made.fabric.fabric_thickness, rel=1e-9)
    # every crossing is in contact over the whole of its patch
    plan = sum((x1 - x0) * (y1 - y0) for x0, x1, y0, y1 in contact_patches(made.fabric).values())
    assert (
        plan
        < found["contact_area_mm2"]
        < plan * (1 + made.fabric.weft.slope**2 + made.fabric.warp.slope**2)
    )


def test_elements_are_hexahedra_as_good_as_the_edges_allow(made):
    mesh = made.report["mesh"]
    assert mesh["other_elements"] == 0
    assert mesh["contact_nodes"] == mesh["coincident_contact_nodes"] > 0
    assert mesh["end_nodes"] == mesh["matching_end_nodes"] > 0
    allowed = allowed_scaled_jacobian(made.fabric)
    assert mesh["scaled_jacobian_edges_allow"] == allowed
    assert mesh["min_scaled_jacobian"] >= min(0.30, 0.9 * allowed)
    assert mesh["min_opposite_edge_ratio"] > 0.01  # no side is collapsed
    assert (
        0 < mesh["min_corner_angle_deg"] < 90 < mesh["max_corner_angle_deg"] < 180
        and mesh["max_aspect"] > 1
    )


def test_volumes_are_those_of_the_model(made):
    """Between two planes the section blends with 3 t^2 - 2 t^3, whose mean is 1/2."""
    from fabric_cad.cad import read_step

    solids = read_step(made.file("step"))
    fabric = made.fabric
    for swept in swept_yarns(fabric):
        planes = swept.planes
        areas = [section_area(section) for section in swept.sections]
        expected = sum(
            (after.place - before.place) * (first + second) / 2
            for before, after, first, second in zip(planes, planes[1:], areas, areas[1:])
        )
        solid = solids[swept.yarn.name]
        assert solid.isValid()
        # rational sections do not blend linearly, their weights being close but not the same
        assert solid.Volume(1e-9) == pytest.approx(
            expected, rel=1e-6 if fabric.section != "round" else 1e-3
        )
    assert made.report["volumes"]["yarn_mm3"] == pytest.approx(
        sum(s.Volume(1e-9) for s in solids.values()), rel=1e-12
    )


def test_step_has_names_colours_and_common_tangents(made):
    import cadquery as cq
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
    from OCP.gp import gp_Vec

    assembly = cq.Assembly.importStep(str(made.file("step")))
    names, colours = [], {"weft": set(), "warp": set()}
    for _, name, _, colour in assembly:
        names.append(name.split("/")[-1])
        colours[names[-1].split("_")[0]].add(tuple(round(c, 3) for c in colour.toTuple()[:3]))
    assert names == [yarn.name for yarn in yarns_of(made.fabric.weave.interlacement())]
    assert len(colours["weft"]) == len(colours["warp"]) == 1 and colours["weft"] != colours["warp"]

    def normal(face, point):
        surface = BRep_Tool.Surface_s(face.wrapped)
        at = GeomAPI_ProjectPointOnSurf(point, surface).LowerDistanceParameters()
        p, du, dv = point.__class__(), gp_Vec(), gp_Vec()
        surface.D1(*at, p, du, dv)
        return np.array(du.Crossed(dv).Normalized().Coord())

    shape, name, *_ = next(iter(assembly))
    along = "x" if name.split("/")[-1].startswith("weft") else "y"
    solid, checked = shape.Solids()[0], 0
    for edge in solid.Edges():
        start, end = edge.startPoint(), edge.endPoint()
        faces = [
            face for face in edge.ancestors(solid, "Face").Faces() if face.geomType() == "BSPLINE"
        ]
        if len(faces) != 2 or abs(getattr(start, along) - getattr(end, along)) > 1e-7:
            continue  # true edges and the seams of strips run along the yarn, end sections are planar
        curve = BRepAdaptor_Curve(edge.wrapped)
        for share in (0.07, 0.5, 0.81):
            u = curve.FirstParameter() + share * (curve.LastParameter() - curve.FirstParameter())
            one, other = (normal(face, curve.Value(u)) for face in faces)
            assert np.degrees(np.arccos(min(1.0, abs(one @ other)))) < 0.01
            checked += 1
    yarn = yarns_of(made.fabric.weave.interlacement())[0]
    swept = SweptYarn(made.fabric, yarn)
    assert checked == 3 * (len(swept.skin.patches) - len(swept.sections[0].strips))


def test_step_is_small(twill32):
    assert twill32.file("step").stat().st_size <= 2_000_000


def test_common_volume_by_boolean_operation(twill32):
    from fabric_cad.cad import read_step

    solids = read_step(twill32.file("step"))
    for pair in (
        ("weft_1", "warp_1"),
        ("weft_1", "warp_5"),
        ("weft_3", "warp_2"),
        ("weft_1", "weft_2"),
    ):
        first, second = (solids[name] for name in pair)
        assert first.intersect(second).Volume() < 1e-9


def test_inspection_sees_a_yarn_out_of_place(twill32):
    from fabric_cad.cad import inspect_cell, read_step

    solids = read_step(twill32.file("step"))
    down = solids | {
        "weft_2": solids["weft_2"].moved(z=-1e-4)
    }  # into the warps below, off those above
    found = inspect_cell(down)
    assert found.max_penetration == pytest.approx(1e-4, rel=1e-6)
    assert found.max_contact_gap == pytest.approx(1e-4, rel=1e-6)
    plan = twill32.fabric.weft.width * twill32.fabric.warp.width
    assert found.overlap_volume == pytest.approx(3 * plan * 1e-4, rel=1e-6)  # over three warps
    aside = solids | {"weft_2": solids["weft_2"].moved(y=0.05)}
    assert inspect_cell(aside).max_penetration > 1e-4


def test_mesh_file_by_another_reader(made):
    mesh = meshio.read(made.file("msh"))
    kinds = {block.type for block in mesh.cells}
    assert kinds == {"hexahedron", "quad"}
    hexahedra = np.vstack([block.data for block in mesh.cells if block.type == "hexahedron"])
    assert len(hexahedra) == made.report["mesh"]["hexahedra"]
    assert (
        len(mesh.points) == len(np.unique(hexahedra)) == made.report["mesh"]["nodes"]
    )  # no orphan
    names = {yarn.name for yarn in yarns_of(made.fabric.weave.interlacement())}
    kinds = ("contact", "free", "start", "end")
    assert set(mesh.field_data) == names | {f"{name}_{kind}" for name in names for kind in kinds}
    assert all(
        dimension == (3 if name in names else 2) for name, (_, dimension) in mesh.field_data.items()
    )


def test_vtu_by_another_reader(twill32):
    mesh = meshio.read(twill32.file("vtu"))
    data = {name: blocks[0] for name, blocks in mesh.cell_data.items()}
    assert set(data) == {
        *("yarn", "direction", "fibre_axis"),
        *("scaled_jacobian", "opposite_edge_ratio", "least_angle", "aspect"),
    }
    assert data["scaled_jacobian"].min() == pytest.approx(
        twill32.report["mesh"]["min_scaled_jacobian"]
    )
    assert np.linalg.norm(data["fibre_axis"], axis=1) == pytest.approx(1)
    fibre = np.abs(data["fibre_axis"])
    assert (fibre[data["direction"] == 0, 0] > 0.7).all() and (
        fibre[data["direction"] == 1, 1] > 0.7
    ).all()
    assert set(np.unique(data["yarn"])) == set(range(1, 11))


def test_picture_shows_both_directions(made):
    image = np.asarray(Image.open(made.file("png")).convert("RGB"), dtype=int)
    assert image.shape[0] >= 900 and image.shape[1] >= 1200
    red, blue = image[..., 0], image[..., 2]
    for share in ((red - blue > 60).mean(), (blue - red > 60).mean()):
        assert share > 0.05
    assert (image.min(axis=2) > 250).mean() > 0.1  # and a white ground


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
def test_calculix_reads_the_deck_without_complaint(made):
    run = subprocess.run(
        ["ccx", made.name],
        cwd=made.folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    for left in made.folder.glob(f"{made.name}.*"):
        if left.suffix in (".cvg", ".dat", ".sta", ".frd", ".12d"):
            left.unlink()
    (made.folder / "spooles.out").unlink(missing_ok=True)
    assert run.returncode == 0 and "Job finished" in run.stdout
    assert "WARNING" not in run.stdout and "ERROR" not in run.stdout


def test_masters_open_in_cq_editor(twill32, monkeypatch):
    """CQ-editor runs a script with ``show_object``; so does CadQuery's own gateway."""
    import cadquery as cq
    from cadquery import cqgi

    from fabric_cad.masters import twill

    script = cqgi.parse(open(twill.__file__, encoding="utf-8").read())
    assert "SOLVED" in script.metadata.parameters
    result = script.build({"SOLVED": str(twill32.folder / "solved.csv")})
    assert result.success, result.exception
    shapes = [shown.shape for shown in result.results]
    solids = [shape for shape in shapes if isinstance(shape, cq.Solid)]
    assert [solid.Volume() for solid in solids] == pytest.approx([8.0491091] * 10)


def test_sizes_and_numbers_of_elements(twill32, tmp_path):
    row, _ = find_row(shipped_families(), "twill32")
    six = make_cell(row, tmp_path, {"through": 6})["mesh"]
    assert six["min_scaled_jacobian"] >= 0.20
    assert six["contact_nodes"] == six["coincident_contact_nodes"]
    uneven = make_cell(row, tmp_path, {"across": 8, "crossing": 10, "gap": 2})["mesh"]
    # wefts: 8 across, 10 along each crossing; warps the other way round; 2 through
    in_section = {across: 2 * (across - 4) + 6 for across in (8, 10)}
    assert uneven["hexahedra"] == 5 * 5 * (in_section[8] * (10 + 2) + in_section[10] * (8 + 2))
    assert uneven["contact_nodes"] == uneven["coincident_contact_nodes"] == 2 * 25 * 9 * 11
    sized = make_cell(row, tmp_path, {"size": 0.3})["mesh"]
    assert sized["hexahedra"] == 10 * 5 * (2 * (8 - 4) + 6) * (8 + 2)


def test_known_data_give_areal_density_and_fibre_fractions(tmp_path):
    from fabrics import TWILL32, table

    tex, density = 400.0, 1.79
    row = table("twill", TWILL32 | {"weft_linear_density_tex": tex, "fibre_density_g_cm3": density})
    made = make_cell(row, tmp_path, {"size": 0.6})
    volumes = made["volumes"]
    assert volumes["areal_density_g_m2"] == pytest.approx(2 * 0.35 * tex * 1.004)
    fibre = (
        volumes["areal_density_g_m2"] / density / 1000 * (5 / 0.35) ** 2
    )  # mm of solid fibre x mm2 of cell
    assert volumes["weft_fibre_fraction"] == pytest.approx(fibre / volumes["yarn_mm3"])
    assert volumes["warp_fibre_fraction"] == pytest.approx(volumes["weft_fibre_fraction"])


def test_step_is_the_same_to_the_byte_and_says_what_made_it(twill32, tmp_path):
    """Another process writes the same file, under any name; so does this one, once more."""
    fabric_cad.build_cell(twill32.fabric).write_step(tmp_path / "again.step")
    assert (tmp_path / "again.step").read_bytes() == twill32.file("step").read_bytes()
    code = f"""
from fabric_cad import build_cell, read_solved
build_cell(read_solved({str(twill32.folder / "solved.csv")!r})).write_step({str(tmp_path / "other.step")!r})
"""
    subprocess.run([sys.executable, "-c", code], check=True)
    written = (tmp_path / "other.step").read_bytes()
    assert written == twill32.file("step").read_bytes()
    header = written.decode().split("ENDSEC;")[0]
    assert "FILE_DESCRIPTION(('Elementary cell of the fabric twill32')" in header
    assert "FILE_NAME('twill32'," in header and f"'fabric_cad {fabric_cad.__version__}'" in header
