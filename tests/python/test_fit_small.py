"""A small fit of a real crack finds the parameters that its observations were made with."""
import fit_recovery


def test_known_parameters_are_recovered(tmp_path):
    trial = fit_recovery.run_trial(3, tmp_path, evaluations=14, observed=2, fitted=1)
    assert trial.is_recovered
    assert trial.result.parameters["determined"].all()
    assert not list((tmp_path / "fit" / "runs").iterdir())
