"""Time of a step on many ranks, from what was measured on one machine.

A rank has a band of rows of a sheet of `columns` sites a row. Each step moves its sites, exchanges two rows at either end
of the band with the rank beyond it, and adds one number up over all ranks. Nothing overlaps, the worst case:

    T = n t_site + 2 (latency + bytes / bandwidth) + log2(ranks) t_reduction
"""
import dataclasses
import math

HALO_ROWS = 2    # as far as next-nearest neighbours reach
HALO_FIELDS = 4  # two components of position and of velocity, 8 bytes each


@dataclasses.dataclass(frozen=True)
class Machine:
    site_seconds: float  # t_site: of one site in one step, on one core of a machine all of whose cores work [s]
    latency: float       # of a short message [s]
    bandwidth: float     # of a long message, both ways at once [byte/s]
    reduction: float     # t_reduction: of one number over two ranks [s]


def halo_bytes(columns):
    """Sent to one neighbour in one step [byte]."""
    return 8. * HALO_ROWS * HALO_FIELDS * columns


def step_seconds(machine, sites_per_rank, columns, ranks):
    """T [s]."""
    if ranks == 1:
        return sites_per_rank * machine.site_seconds
    halo = 2. * (machine.latency + halo_bytes(columns) / machine.bandwidth)
    return sites_per_rank * machine.site_seconds + halo + math.log2(ranks) * machine.reduction


def efficiency(machine, sites_per_rank, columns, ranks):
    """Time of the sites over the whole time [-]: speed-up over the number of ranks."""
    return sites_per_rank * machine.site_seconds / step_seconds(machine, sites_per_rank, columns, ranks)


def message_times(exchanges):
    """(latency [s], bandwidth [byte/s]) from pairs of (bytes, seconds): of the shortest message, and of the slowest whose
    length is that of a halo, 16 KiB to 1 MiB."""
    shortest = min(exchanges)[1]
    rates = [n_bytes / seconds for n_bytes, seconds in exchanges if 2**14 <= n_bytes <= 2**20]
    return shortest, min(rates)
