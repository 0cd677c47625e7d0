"""Stability of a loaded lattice, computed independently of the program. Equations are those of docs/theory-comparison.md."""
import numpy as np

SPACING = 1.0  # of the lattice; the results do not depend on it
SECTIONS = {"nearest": 0.72, "next": 0.81}  # of quick.prm


def rod(a, b):
    """Force and stiffness of a Mooney-Rivlin bond, eq. (L.3)."""
    return (lambda s: a * (s - s**-2) + b * (1 - s**-3)), (lambda s: a * (1 + 2 * s**-3) + 3 * b * s**-4)


def spring(modulus):
    """Force and stiffness of a linear bond."""
    return (lambda s: modulus * (s - 1)), (lambda s: modulus)


class Lattice:
    """A lattice of one bond law at the stretches (x, y), eq. (W.1): for each bond direction its unit vector N, length l,
    weight c = A0 l / V, force over stretch and stiffness matrix h."""

    def __init__(self, law, shells, x, y):
        force, stiffness = law
        kinds = [("nearest", 1.0, (0, 60, 120))] + ([("next", np.sqrt(3), (30, 90, 150))] if shells == "NN+NNN" else [])
        N = np.array([[np.cos(np.radians(angle)), np.sin(np.radians(angle))] for _, _, angles in kinds for angle in angles])
        self.N = N
        self.length = np.array([length for _, length, angles in kinds for _ in angles])
        self.weight = self.length * np.array([SECTIONS[name] for name, _, angles in kinds for _ in angles])
        bond = N * np.array([x, y])
        stretch = np.linalg.norm(bond, axis=1)
        n = bond / stretch[:, np.newaxis]
        along = n[:, :, np.newaxis] * n[:, np.newaxis, :]
        self.pull = np.array([force(s) / s for s in stretch])
        axial, pull = np.array([stiffness(s) for s in stretch])[:, np.newaxis, np.newaxis], self.pull[:, np.newaxis, np.newaxis]
        self.h = axial * along + pull * (np.eye(2) - along)

    def smallest_squared_speed(self):
        """Smallest w^2 / k^2 of all waves, up to a factor; not positive: unstable."""
        angles, lengths = np.meshgrid(np.pi * np.arange(120) / 120, np.linspace(0.01, 4 * np.pi / 3, 61))
        K = np.stack((np.cos(angles) * lengths, np.sin(angles) * lengths), axis=-1).reshape(-1, 2)
        phase = 4 * np.sin(0.5 * (K @ self.N.T) * self.length)**2 * self.weight / self.length**2
        matrices = np.einsum("kb,bij->kij", phase, self.h)
        return (np.linalg.eigvalsh(matrices)[:, 0] / (K**2).sum(axis=1)).min()

    def outcome(self):
        """Expected outcome for a crack in this loaded sheet: accepted, or refused because the sheet buckles."""
        return BUCKLES if self.smallest_squared_speed() <= 0 else ACCEPTED


ACCEPTED, BUCKLES = "·", "B"
