"""Grids: quadrature is exact where it claims to be, and corners become nodes without tiny steps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from satsym.grid import CLOSEST, Grid, interleave

points_inside = st.lists(st.floats(-0.5, 3.5), max_size=12)


def test_a_uniform_grid_meets_both_ends_exactly():
    grid = Grid.uniform(0.1, 6.283185307179586, 7)
    assert (grid.t0, grid.tf, grid.steps) == (0.1, 6.283185307179586, 7)
    assert np.allclose(grid.widths, grid.widths[0], rtol=1e-14)
    assert np.allclose(grid.midpoints, (grid.nodes[:-1] + grid.nodes[1:]) / 2, rtol=1e-15)


@pytest.mark.parametrize(
    "nodes", [[0.0], [], [0.0, 0.0], [1.0, 0.0], [0.0, float("nan")], [0.0, float("inf")], [[0.0, 1.0]]]
)
def test_nodes_that_do_not_increase_are_refused(nodes):
    with pytest.raises(ValueError, match="strictly increase"):
        Grid(np.array(nodes))


def test_other_impossible_grids_are_refused():
    with pytest.raises(ValueError, match="at least one step"):
        Grid.uniform(0.0, 1.0, 0)
    with pytest.raises(ValueError, match="one of its nodes"):
        Grid(np.array([0.0, 1.0]), (0.5,))
    with pytest.raises(ValueError, match="fraction"):
        Grid.uniform(0.0, 1.0, 2).with_corners([0.3], closest=0.4)


def test_a_grid_cannot_be_changed_through_its_arrays():
    given_nodes = np.array([0.0, 1.0, 2.0])
    grid = Grid(given_nodes)
    given_nodes[1] = 7.0
    assert grid.nodes[1] == 1.0
    for array in (grid.nodes, grid.widths, grid.midpoints, grid.node_weights, grid.midpoint_weights):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


@given(points_inside)
def test_simpson_weights_integrate_cubics_exactly_on_any_grid(points):
    grid = Grid.uniform(0.0, 3.0, 5).with_corners(points)
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0])
    exact = cubic.integ()(3.0)
    found = cubic(grid.nodes) @ grid.node_weights + cubic(grid.midpoints) @ grid.midpoint_weights
    assert abs(found - exact) < 1e-12 * abs(exact)


def test_a_corner_in_the_middle_of_a_step_becomes_a_node():
    grid = Grid.uniform(0.0, 4.0, 4).with_corners([1.5])
    assert grid.nodes.tolist() == [0.0, 1.0, 1.5, 2.0, 3.0, 4.0]
    assert grid.corners == (1.5,)


def test_a_node_near_a_corner_moves_there():
    grid = Grid.uniform(0.0, 4.0, 4).with_corners([1.1, 2.9])
    assert grid.nodes.tolist() == [0.0, 1.1, 2.0, 2.9, 4.0]
    assert grid.corners == (1.1, 2.9)


def test_ends_stay_and_a_corner_too_close_to_what_cannot_move_is_left_out():
    grid = Grid.uniform(0.0, 4.0, 4).with_corners([0.1, 3.9, -1.0, 5.0, 0.0, 4.0, 1.5, 1.6])
    assert grid.nodes.tolist() == [0.0, 1.0, 1.5, 2.0, 3.0, 4.0]
    assert grid.corners == (1.5,)


def test_an_earlier_corner_stays_when_later_ones_are_inserted():
    grid = Grid.uniform(0.0, 4.0, 4).with_corners([1.1]).with_corners([1.2, 1.6])
    assert 1.1 in grid.nodes
    assert grid.corners == (1.1, 1.6)


@given(points_inside)
def test_inserting_corners_keeps_the_spacing_and_accounts_for_every_point(points):
    before = Grid.uniform(0.0, 3.0, 6)
    after = before.with_corners(points)
    rounding = 1e-12
    assert (after.t0, after.tf) == (before.t0, before.tf)
    assert after.widths.min() >= CLOSEST * before.widths.min() - rounding
    assert after.widths.max() <= (1 + 2 * CLOSEST) * before.widths.max() + rounding
    reach = CLOSEST * before.widths.max() + rounding
    for point in points:
        if before.t0 < point < before.tf:
            anchors = np.array([before.t0, before.tf, *after.corners])
            assert np.abs(anchors - point).min() <= reach


def test_interleaving_puts_midpoint_values_between_node_values():
    assert interleave(np.array([[0.0, 2.0, 4.0]]), np.array([[1.0, 3.0]])).tolist() == [[0.0, 1.0, 2.0, 3.0, 4.0]]
    assert interleave(np.zeros((0, 3)), np.zeros((0, 2))).shape == (0, 5)
