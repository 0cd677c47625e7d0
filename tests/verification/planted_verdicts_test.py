"""Checks that a verdict file without rows of a claim is reported and ignored, and that the claims are checked."""
import hashlib
import json
import os
import re

from program import CASES, latcon

TINY = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=0.01 ms", "--set",
        "Next-nearest neighbours/present=false"]


def fracture(out, tmp_path):
    environment = dict(os.environ, XDG_CACHE_HOME=str(tmp_path / "cache"))
    run = latcon("fracture", CASES / "quick.prm", "--no-report", "--output-dir", out, *TINY, env=environment)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout, json.loads((out / "run.json").read_text())["verification"]


def test_file_with_other_rows_is_not_used(tmp_path, out):
    assert not fracture(out, tmp_path)[1]["reused"]
    assert fracture(out, tmp_path)[1]["reused"]
    path = tmp_path / "cache" / "latcon" / "verdicts" / f"{fracture(out, tmp_path)[1]['hash']}.json"
    document = json.loads(path.read_text())
    del document["checksum"]
    document["results"]["claims"] = [next(row for row in document["results"]["claims"] if row["verdict"] == "holds")]
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False)
    document["checksum"] = hashlib.sha256(text.encode()).hexdigest()
    path.write_text(json.dumps(document, separators=(",", ":"), ensure_ascii=False))
    printed, told = fracture(out, tmp_path)
    assert re.search(f"{path} is not used: the claim [a-z-]+ judged nothing", printed)
    assert "judged nothing" in told["note"]
    assert not told["reused"]
    assert fracture(out, tmp_path)[1]["reused"], "not replaced"
