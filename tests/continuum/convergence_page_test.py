"""Tests of the page of convergence orders, with synthetic tables of known orders."""


import pytest

import convergence_page


def write_table(folder, name, orders, steps=(0.25, 0.125, 0.0625)):
    lines = [",".join(map(repr, [h, *(3. * h**order for order in orders)])) for h in steps]
    (folder / f"{name}.csv").write_text("\n".join(["h [m],L2 [m^2],H1 [m],H2 [1]", *lines]) + "\n")


@pytest.fixture
def tables(tmp_path):
    tables = tmp_path / "tables"
    tables.mkdir()
    return tables


def test_orders_are_those_of_the_errors(tables):
    write_table(tables, "mooney_rivlin_isotropic_uniform_loaded_p3", (3.9, 3.05, 2.2), (0.3, 0.2, 0.05))
    (series,) = convergence_page.read_series(tables)
    assert (series.local, series.gradient, series.mesh, series.degree) == ("mooney_rivlin", "isotropic", "uniform_loaded", 3)
    for norm, order in (("L2", 3.9), ("H1", 3.05), ("H2", 2.2)):
        assert len(series.orders(norm)) == 2
        for observed in series.orders(norm):
            assert observed == pytest.approx(order, abs=1e-12)


def test_theory_loses_an_order_for_quadratic_elements_with_a_gradient_law():
    assert convergence_page.theory("isotropic", 2) == {"L2": 2, "H1": 2, "H2": 1}
    assert convergence_page.theory("local", 2) == {"L2": 3, "H1": 2, "H2": 1}
    assert convergence_page.theory("lattice", 4) == {"L2": 5, "H1": 4, "H2": 3}


def test_page_shows_every_series(tables, tmp_path):
    write_table(tables, "network_local_uniform_p2", (3.01, 2.02, 1.03))
    write_table(tables, "network_local_hanging_p2", (2.97, 1.96, 0.95))
    write_table(tables, "network_lattice_uniform_loaded_p4", (5., 4., 3.))
    assert convergence_page.main(tables, tmp_path / "docs") == 0
    page = (tmp_path / "docs" / "convergence.md").read_text(encoding="utf-8")
    assert "| without gradient law | 2 | 2 | 3 | 2.97 … 3.01 | 2 | 1.96 … 2.02 | 1 | 0.95 … 1.03 |" in page
    errors = (tmp_path / "docs" / "convergence.csv").read_text(encoding="utf-8")
    assert "without gradient law,network of fibres (C.11),\"uniform, clamped\",2,1/4,4.62e-02,," in errors
    assert "\"uniform, clamped\",2,1/16,7.12e-04,3.01," in errors
    assert "isotropic.png" not in page
    for name in ("local", "lattice"):
        assert f"images/convergence-{name}.png" in page
        assert (tmp_path / "docs" / "images" / f"convergence-{name}.png").read_bytes()[:4] == b"\x89PNG"


def test_what_is_no_series_is_refused(tables):
    with pytest.raises(convergence_page.BadTable):
        convergence_page.read_series(tables)
    for name, text in (("network_local_uniform_p2", "h\n0.1,x,1,1\n0.05,1,1,1\n"), ("other", "h\n1,1,1,1\n2,1,1,1\n"),
                       ("network_local_uniform_p3", "h\n0.1,0,1,1\n0.05,1,1,1\n")):
        path = tables / f"{name}.csv"
        path.write_text(text)
        with pytest.raises(convergence_page.BadTable, match=path.name):
            convergence_page.read_series(tables)
        path.unlink()
