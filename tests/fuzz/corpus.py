#!/usr/bin/python3
"""Writes the seed corpus of libFuzzer: the shipped cases and studies, options of --set, and a dictionary of all words of a case.

Usage: corpus.py FORK_SERVER CORPUS DICTIONARY
"""
import argparse
import json
import pathlib
import sys

sys.dont_write_bytecode = True
from mutate import BYTES, CASES, EXPRESSIONS, NUMBERS, STUDIES, UNITS, Fuzzer, case_lines, prm


def json_of(entries):
    document = {}
    for section, name, value in entries:
        document.setdefault(section, {})[name] = value
    return json.dumps(document, indent=1)


def quoted(word):
    return '"' + "".join(f"\\x{byte:02x}" for byte in word) + '"\n'


def main():
    server, corpus, dictionary = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    fuzzer = Fuzzer(argparse.Namespace(server=server, limit=60., seed=0, failures=""))
    entries = fuzzer.full
    fuzzer.close()
    corpus.mkdir(parents=True, exist_ok=True)
    seeds = {}
    for path in CASES:
        short = case_lines(path.read_text())
        seeds[path.name] = b"\0" + prm(short).encode()
        seeds[path.name + ".json"] = b"\1" + json_of(short).encode()
        seeds[path.name + ".set"] = b"\2" + "\n".join(f"{s}/{n}={v}" for s, n, v in short).encode()
    seeds["all"] = b"\0" + prm(entries).encode()
    seeds["all.json"] = b"\1" + json_of(entries).encode()
    for number, (section, name, value) in enumerate(entries):
        seeds[f"set-{number}"] = b"\2" + f"{section}/{name}={value}".encode()
    for path in STUDIES:
        seeds[path.name] = b"\3" + json.dumps(json.loads(path.read_text())).encode()
    for name, data in seeds.items():
        (corpus / name).write_bytes(data)
    words = {word for section, name, value in entries for word in (section, name, value)}
    words |= {*NUMBERS, *EXPRESSIONS, *UNITS, "subsection", "set", "end", "runs", "claims", "rows", "quantity", "seeds", "is near"}
    known = {word.encode("utf8") for word in words} | {word for word in BYTES if len(word) < 20}
    dictionary.write_text("".join(sorted(quoted(word) for word in known if word)))


if __name__ == "__main__":
    main()
