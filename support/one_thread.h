#pragma once

#include <omp.h>

namespace latcon::support
{

/// Makes OpenMP use one thread while it lives, for lattices so small that threads wait for each other more than they
/// share. Bits do not depend on the number of threads.
class OneThread
{
public:
  OneThread() : threads_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(threads_); }
  OneThread(const OneThread &) = delete;
  OneThread &operator=(const OneThread &) = delete;

private:
  int threads_;
};

} // namespace latcon::support
