"""Page of convergence orders, from synthetic tables of known orders."""
import pytest

import convergence_page


def write_table(folder, name, orders, steps=(0.25, 0.125, 0.0625)):
    lines = [",".join(map(repr, [h, *(3. * h**order for order in orders)])) for h in steps]
    (folder / f"{name}.csv").write_text("\n".join(["h [m],L2 [m^2],H1 [m],H2 [1]", *lines]) + "\n")


def test_orders_are_those_of_the_errors(tmp_path):
    write_table(tmp_path, "mooney_rivlin_isotropic_uniform_loaded_p3", (3.9, 3.05, 2.2), (0.3, 0.2, 0.05))
    (series,) = convergence_page.read_series(tmp_path)
    assert (series.local, series.gradient, series.mesh, series.degree) == ("mooney_rivlin", "isotropic", "uniform_loaded", 3)
    for norm, order in (("L2", 3.9), ("H1", 3.05), ("H2", 2.2)):
        assert len(series.orders(norm)) == 2
        for observed in series.orders(norm):
            assert observed == pytest.approx(order, abs=1e-12)


def test_page_shows_every_series(tmp_path):
    write_table(tmp_path, "network_local_uniform_p2", (3.01, 2.02, 1.03))
    write_table(tmp_path, "network_local_hanging_p2", (2.97, 1.96, 0.95))
    write_table(tmp_path, "network_lattice_uniform_loaded_p4", (5., 4., 3.))
    assert convergence_page.main(tmp_path, tmp_path / "docs") == 0
    page = (tmp_path / "docs" / "convergence.md").read_text(encoding="utf-8")
    assert "| without gradient law | 2 | 2 | 3 | 2.97 … 3.01 | 2 | 1.96 … 2.02 | 1 | 0.95 … 1.03 |" in page
    errors = (tmp_path / "docs" / "convergence.csv").read_text(encoding="utf-8")
    assert "without gradient law,network of fibres (C.11),\"uniform, clamped\",2,1/4,4.62e-02,," in errors
    assert "\"uniform, clamped\",2,1/16,7.12e-04,3.01," in errors
    assert "isotropic.png" not in page
    for name in ("local", "lattice"):
        assert f"images/convergence-{name}.png" in page
        assert (tmp_path / "docs" / "images" / f"convergence-{name}.png").read_bytes()[:4] == b"\x89PNG"


def test_what_is_no_series_is_refused(tmp_path):
    with pytest.raises(convergence_page.BadTable):
        convergence_page.read_series(tmp_path)
    for name, text in (("network_local_uniform_p2", "h\n0.1,x,1,1\n0.05,1,1,1\n"), ("other", "h\n1,1,1,1\n2,1,1,1\n"),
                       ("network_local_uniform_p3", "h\n0.1,0,1,1\n0.05,1,1,1\n")):
        path = tmp_path / f"{name}.csv"
        path.write_text(text)
        with pytest.raises(convergence_page.BadTable, match=path.name):
            convergence_page.read_series(tmp_path)
        path.unlink()
