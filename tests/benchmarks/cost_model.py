"""Model for the time of a step on many ranks, from measurements on one machine.

Each rank has a band of rows, with `columns` sites per row. In each step it moves its sites, exchanges two rows at either end
of the band with the neighbouring rank, and takes part in a sum of one number over all ranks. Nothing overlaps (worst case):

    T = n t_site + 2 (latency + bytes / bandwidth) + log2(ranks) t_reduction
"""
import dataclasses
import math

HALO_ROWS = 2    # as far as next-nearest neighbours reach
HALO_FIELDS = 4  # two components of position and of velocity, 8 bytes each


@dataclasses.dataclass(frozen=True)
class Machine:
    site_seconds: float  # t_site: time per site and step, on one core of a machine with all cores busy [s]
    latency: float       # of a short message [s]
    bandwidth: float     # of a long message, both ways at once [byte/s]
    reduction: float     # t_reduction: of one number over two ranks [s]


def halo_bytes(columns):
    """Bytes sent to one neighbour in one step."""
    return 8. * HALO_ROWS * HALO_FIELDS * columns


def step_seconds(machine, sites_per_rank, columns, ranks):
    """T [s]."""
    if ranks == 1:
        return sites_per_rank * machine.site_seconds
    halo = 2. * (machine.latency + halo_bytes(columns) / machine.bandwidth)
    return sites_per_rank * machine.site_seconds + halo + math.log2(ranks) * machine.reduction


def efficiency(machine, sites_per_rank, columns, ranks):
    """Parallel efficiency [-]: time of the sites over the total time."""
    return sites_per_rank * machine.site_seconds / step_seconds(machine, sites_per_rank, columns, ranks)


def message_times(exchanges):
    """(latency [s], bandwidth [byte/s]) from pairs of (bytes, seconds): latency of the shortest message, and lowest
    bandwidth of messages as long as a halo, 16 KiB to 1 MiB."""
    shortest = min(exchanges)[1]
    rates = [n_bytes / seconds for n_bytes, seconds in exchanges if 2**14 <= n_bytes <= 2**20]
    return shortest, min(rates)
