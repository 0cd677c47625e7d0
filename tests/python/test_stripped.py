"""The notebooks are stored without outputs, and the page of the package names each."""
import json
import pathlib

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"


def test_notebooks_have_no_outputs():
    paths = sorted((DOCS / "notebooks").glob("*.ipynb"))
    assert len(paths) >= 5
    for path in paths:
        book = json.loads(path.read_text(encoding="utf-8"))
        assert book["nbformat"] == 4 and book["metadata"]["kernelspec"]["name"] == "python3", path
        assert book["cells"][0]["source"][0].startswith("# "), path
        for cell in book["cells"]:
            assert not cell.get("outputs") and cell.get("execution_count") is None, f"{path}: clear all outputs"


def test_page_names_each_notebook():
    page = (DOCS / "python.md").read_text(encoding="utf-8")
    for path in (DOCS / "notebooks").glob("*.ipynb"):
        assert f"(notebooks/{path.name})" in page, path
