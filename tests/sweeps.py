"""Random fabrics and points on the skins of their yarns."""

import numpy as np
from fabrics import table
from hypothesis import assume
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from fabric_cad.model.identification import identify
from fabric_cad.support.errors import InputError

seeds = st.integers(0, 2**32 - 1)


def fabric_of(draw, seed):
    family, row = draw(np.random.default_rng(seed))
    try:
        return identify(table(family, row))[row["name"]]
    except InputError:
        assume(False)


def points(patch, u, v, along=0):
    """Points (t, v, z) of a patch on a grid of shares of its parameters, or their rate along t."""
    homogeneous = patch.poles * np.where(np.arange(4) < 3, patch.poles[..., 3:], 1.0)
    (ku, du), (kv, dv) = patch.along, patch.across
    at = ku[0] + np.asarray(u) * (ku[-1] - ku[0])

    def grid(order):
        return BSpline(kv, BSpline(ku, homogeneous, du)(at, order).transpose(1, 0, 2), dv)(
            v
        ).transpose(1, 0, 2)

    found = grid(0)
    place = found[..., :3] / found[..., 3:]
    if not along:
        return place
    rate = grid(1)
    tangent = (rate[..., :3] - place * rate[..., 3:]) / found[..., 3:]
    return tangent / tangent[..., :1]


def patch_of(surface, segment, side):
    return next(
        patch for patch in surface.patches if (patch.segment, patch.side) == (segment, side)
    )
