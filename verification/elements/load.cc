#include "verification/elements/elements.h"

#include <cstdlib>
#include <new>

#include <dlfcn.h>
#include <sys/mman.h>

#include "verification/input/files.h"

namespace latcon::elements
{
namespace
{

std::shared_ptr<void> started; // libraries of the finite elements

const Elements &load()
{
  const std::string file = input::module_file();
  if (file.empty())
    throw support::Error(support::ExitCode::output_failed,
                         "the module with the finite elements is neither beside the program nor in ../lib/latcon; "
                         "install latcon as a whole, or link to the program");
  // The sums of a threaded BLAS depend on the number of threads, and its threads would be idle. OpenBLAS starts them
  // while it is loaded.
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  // Lazily: binding every function of its libraries takes a quarter of a short command.
  void *const module = dlopen(file.c_str(), RTLD_LAZY | RTLD_GLOBAL);
  if (module == nullptr)
    throw support::Error(support::ExitCode::output_failed,
                         std::string("the module with the finite elements cannot be loaded: ") + dlerror());
  // OpenBLAS asks for a buffer of 128 MiB until it gets one.
  constexpr std::size_t needed = 160 << 20;
  void *const buffer = mmap(nullptr, needed, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (buffer == MAP_FAILED)
    throw std::bad_alloc();
  munmap(buffer, needed);
  using Entry = const Elements *(*)();
  const auto entry = reinterpret_cast<Entry>(dlsym(module, "latcon_elements"));
  if (entry == nullptr)
    throw support::Error(support::ExitCode::output_failed, file + ": not the module of this program");
  started = entry()->start();
  return *entry();
}

} // namespace

const Elements &elements()
{
  static const Elements &table = load();
  return table;
}

void finish()
{
  started.reset();
}

} // namespace latcon::elements
