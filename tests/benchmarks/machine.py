"""Description of the machine and the build: processor, compiler, commit, date."""
import datetime
import re
import subprocess

from measure import ROOT


def output_of(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def processor():
    """Model, cores, caches and widest vectors, as `lscpu` says."""
    fields = dict(re.findall(r"^\s*([^:\n]+):\s+(.*)$", output_of("lscpu"), re.MULTILINE))
    widest = (("avx512f", "AVX-512"), ("avx2", "AVX2"), ("sse2", "SSE2"))
    return {"model": fields.get("Model name", "unknown"), "family": fields.get("CPU family"), "cores": int(fields.get("CPU(s)", 0)),
            "caches": {name: fields[f"{name} cache"] for name in ("L1d", "L1i", "L2", "L3") if f"{name} cache" in fields},
            "vectors": next((name for flag, name in widest if flag in fields.get("Flags", "").split()), "unknown")}


def memory():
    """Memory of the machine [byte]."""
    with open("/proc/meminfo", encoding="ascii") as file:
        return 1024 * int(re.search(r"MemTotal:\s+(\d+)", file.read()).group(1))


def compiler(build):
    """Compiler and flags of a build folder."""
    cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
    return {"compiler": output_of(cache["CMAKE_CXX_COMPILER"], "--version").split("\n")[0],
            "build_type": cache.get("CMAKE_BUILD_TYPE", "")}


def facts(build):
    return {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"),
            "commit": output_of("git", "describe", "--always", "--abbrev=12", "--dirty", "--exclude=*"),
            "processor": processor(), "memory_bytes": memory(),
            **compiler(build)}
