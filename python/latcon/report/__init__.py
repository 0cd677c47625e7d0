"""Pages of output directories: report of runs, study, comparison of two cracks."""
