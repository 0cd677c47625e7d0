// The program for tests. With arguments it is latcon. Without, it runs latcon in children made by fork (forked.py):
// what takes half a second to start, MPI, the module with the finite elements, Python and its packages, starts once.
// Where such a child, or a child of it, would replace itself by Python or by latcon, it runs those of the server.
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include <dlfcn.h>
#include <mpi.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

#include "support/mpi_session.h"
#include "verification/commands/command_line.h"
#include "verification/elements/elements.h"
#define main latcon_main
#include "verification/main.cc"
#undef main

using namespace latcon;

namespace
{

bool is_child = false; // of the server, or of such a child

PyObject *list_of(char *const words[])
{
  PyObject *const list = PyList_New(0);
  for (; *words != nullptr; ++words)
    PyList_Append(list, PyBytes_FromString(*words));
  return list;
}

void serve()
{
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.safe_path = 1;
  config.user_site_directory = config.install_signal_handlers = config.write_bytecode = 0;
  PyConfig_SetBytesString(&config, &config.program_name, PYTHON);
  PyConfig_SetBytesString(&config, &config.pythonpath_env, PACKAGES);
  if (PyStatus_Exception(Py_InitializeFromConfig(&config)) || PyRun_SimpleString("import forked; forked.serve()") != 0)
    _exit(99);
}

} // namespace

extern "C"
{

  // Loaded before a fork, the module serves all later children.
  void load_elements()
  {
    static_cast<void>(elements::elements());
  }

  // Runs latcon in this process, which ends with it.
  void run_latcon(char *argv[], bool handles_signals)
  {
    is_child = true;
    if (handles_signals)
      commands::install_signal_handlers();
    int argc = 0;
    while (argv[argc] != nullptr)
      ++argc;
    const auto code = commands::run_program(argc, argv);
    std::cout.flush();
    std::fflush(nullptr);
    _exit(static_cast<int>(code));
}

int execve(const char *path, char *const argv[], char *const environment[])
{
  if (is_child)
  {
    PyOS_AfterFork_Child();
    PyObject_CallMethod(PyImport_ImportModule("forked"), "replace_process", "yNN", path, list_of(argv),
                        list_of(environment));
    PyErr_Clear();
  }
  return reinterpret_cast<decltype(&execve)>(dlsym(RTLD_NEXT, "execve"))(path, argv, environment);
}

int execv(const char *path, char *const argv[])
{
  return execve(path, argv, environ);
}

// Ranks that wait for others (OMPI_MCA_mpi_yield_when_idle) sleep: tests share the cores, and one that yields gets its
// core back only when the others' slices have ended, at each of its messages. A process alone waits for nobody.
int sched_yield() noexcept
{
  static const bool is_rank = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  const timespec duration{0, 20000}; // 20 us
  return is_rank ? nanosleep(&duration, nullptr) : 0;
}

// A fork cannot end MPI, as latcon does before it becomes Python. LATCON_INTERRUPT: a signal comes meanwhile.
int MPI_Finalize()
{
  if (std::getenv("LATCON_INTERRUPT") != nullptr)
    std::raise(SIGINT);
  return is_child ? MPI_SUCCESS : PMPI_Finalize();
}
}

int main(int argc, char **argv)
{
  if (argc > 1)
    return latcon_main(argc, argv);
  // Threads do not survive a fork.
  setenv("OMP_NUM_THREADS", "1", 1);
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  const support::MpiSession mpi;
  serve();
  _exit(0); // what the module with the finite elements keeps would be released after it
}
