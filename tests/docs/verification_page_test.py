"""Tests of the comparison of pages by value. verify_test.py compares docs/verification.csv itself with the results."""
import verification_page
from printed_numbers import agrees, differences


def results(*rows):
    return {"claims": [{"claim": "energy", "quantity": quantity, "error": error, "tolerance": tolerance,
                        "verdict": verdict} for quantity, error, tolerance, verdict in rows]}


FOUND = results(("NN+NNN: stress", 1e-3, 1e-2, "holds"), ("NN: stress", 2e-3, 4e-2, "holds"),
                ("NN, F = (2.3, 2.8), kd = 0.1: decay", 3e-13, 1e-9, "holds"), ("NN: sign", 0.0, 0.0, "holds"),
                ("NN: residual", 0.0581, None, "reported"))


def test_differences_are_found_and_round_off_is_none():
    page = verification_page.text(FOUND)
    assert verification_page.differences(page, FOUND) == []
    for i, change, count in ((2, {"error": 2e-8}, 0), (2, {"error": 2e-7}, 1), (0, {"error": 1.04e-3}, 0), (0, {"error": 1.3e-3}, 1),
                             (0, {"tolerance": 1.2e-2}, 1), (3, {"error": 1.0, "verdict": "fails"}, 1), (4, {"quantity": "NN: remainder"}, 1)):
        rows = [dict(row) for row in FOUND["claims"]]
        rows[i].update(change)
        assert len(verification_page.differences(page, {"claims": rows})) == count, change
    assert len(verification_page.differences(page, {"claims": FOUND["claims"][1:]})) == 1


def test_rounding_is_no_difference():
    for one, other in (("0.973", "0.974"), ("5 ± 0.95", "4.99 ± 0.95"), ("0.11", "0.12"), ("1e-09", "9.9e-10"), ("17 %", "18 %"),
                       ("20.2 m/s", "20.200 m/s")):
        assert agrees(one, other), (one, other)


def test_wrong_numbers_and_words_are_found():
    for one, other in (("0.973", "0.975"), ("5 ± 0.95", "5.02 ± 0.95"), ("46", "47"), ("0.3", "0.4"), ("0.01", "0.02"),
                       ("1e-09", "2e-09"), ("17 %", "19 %"), ("0.02", "-0.02"), ("1.0 cm", "1.0 mm"), ("yes 1.0", "no 1.0"),
                       ("20.3 m/s", "20.200 m/s"), ("1.0", "1.0 1.0")):
        assert not agrees(one, other), (one, other)


def test_effects_of_round_off_are_those_that_are_given():
    assert agrees("100.0", "101.0", relative=0.01)
    assert not agrees("100.0", "101.2", relative=0.01)
    assert agrees("+0.02", "+0.03", absolute=0.01)
    assert not agrees("+0.02", "+0.04", absolute=0.01)


def test_lines_are_found_on_a_page():
    page = "words\n\n| a | b |\n| --- | --- |\n| 1.72 | 0.50 |\n| 1.74 | 0.61 |\n\nwords"
    table = ["| a | b |", "| --- | --- |", "| 1.72 | 0.51 |", "| 1.74 | 0.60 |"]
    assert differences(page, table, labels=1) == []
    assert differences(page, [*table[:3], "| 1.75 | 0.60 |"], labels=1) == ["| 1.75 | 0.60 |: the page has | 1.74 | 0.61 |"]
    assert len(differences(page, [*table[:3], "| 1.74 | 0.63 |"])) == 1
    assert len(differences(page, [*table, "| 1.76 | 0.70 |"])) == 1
    assert differences("words", table)
