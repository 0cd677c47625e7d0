"""Tests of docs/verification.csv, in which rows with the same check are merged, and of the comparison of pages by value."""
import verification_page
from printed_numbers import agrees, differences


def results(*rows):
    return {"claims": [{"claim": "energy", "quantity": quantity, "error": error, "tolerance": tolerance,
                        "verdict": verdict} for quantity, error, tolerance, verdict in rows]}


FOUND = results(("NN+NNN: stress", 1e-3, 1e-2, "holds"), ("NN: stress", 2e-3, 4e-2, "holds"),
                ("NN, F = (2.3, 2.8), kd = 0.1: decay", 3e-13, 1e-9, "holds"), ("NN: sign", 0.0, 0.0, "holds"),
                ("NN: residual", 0.0581, None, "reported"))


def test_names_leave_out_states_and_directions():
    for quantity, name in (("NN+NNN: mu at F = I, Mooney-Rivlin", "mu at F = I, Mooney-Rivlin"),
                           ("NN, F = I: long-wave speed, L", "long-wave speed, L"),
                           ("NN+NNN, F = (2.3, 2.8), kd = 0.025: L, decay", "L, decay"),
                           ("NN, sinusoidal field about F = (2.3, 2.8): energy", "sinusoidal field: energy"),
                           ("NN: hole, F = (1.3, 1.1), energy", "hole, energy"),
                           ("NN: smallest eigenvalue at l_d, loaded", "smallest eigenvalue at l_d"),
                           ("NN: alpha of L waves at 49 degrees, run", "alpha of L waves, run"),
                           ("crack speed over c_S, beta 0.5, Delta/Delta_G 1.57", "crack speed over c_S")):
        assert verification_page.shared_name(quantity) == name


def test_table_shows_the_row_that_takes_most_of_its_tolerance():
    assert verification_page.text(FOUND) == (
        "claim,quantity,rows,error,tolerance,verdict\nenergy,stress,2,0.001,0.01,holds\nenergy,decay,1,round-off,1e-09,holds\n"
        "energy,sign,1,0,0,holds\nenergy,residual,1,0.058,,reported\n")


def test_differences_are_found_and_round_off_is_none():
    page = verification_page.text(FOUND)
    assert verification_page.differences(page, FOUND) == []
    for old, new, count in (("NN: residual", "NN: residual", 0), ("residual", "remainder", 1)):
        other = results(*[(row["quantity"].replace(old, new), row["error"], row["tolerance"], row["verdict"])
                          for row in FOUND["claims"]])
        assert len(verification_page.differences(page, other)) == count
    for i, change, count in ((2, {"error": 5e-13}, 0), (2, {"error": 2e-8}, 0), (2, {"error": 2e-7}, 1), (0, {"error": 1.04e-3}, 0), (0, {"error": 1.3e-3}, 1),
                             (0, {"tolerance": 1.2e-2}, 1), (3, {"error": 1.0, "verdict": "fails"}, 1)):
        rows = [dict(row) for row in FOUND["claims"]]
        rows[i].update(change)
        assert len(verification_page.differences(page, {"claims": rows})) == count, change
    assert len(verification_page.differences(page, {"claims": FOUND["claims"][1:]})) == 1
    assert len(verification_page.differences(page, {"claims": FOUND["claims"][:-1]})) == 1
    other = [dict(row, claim="objectivity") for row in FOUND["claims"]]
    assert verification_page.differences(page, {"claims": FOUND["claims"] + other}) [0] == "objectivity: 0 rows, not 4"


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
