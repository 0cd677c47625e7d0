#pragma once

#include <string>

#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace latcon::compare
{

/// While it lives, what VTK has to say about files goes here and not to the terminal. One thread at a time.
class QuietVtk
{
public:
  QuietVtk();
  ~QuietVtk();
  QuietVtk(const QuietVtk &) = delete;
  QuietVtk &operator=(const QuietVtk &) = delete;

  /// The first error, without the place in VTK's sources; empty if there was none.
  std::string error() const;

private:
  // Keeps the first error.
  class Kept : public vtkOutputWindow
  {
  public:
    static Kept *New();
    void DisplayText(const char *) override {}
    void DisplayErrorText(const char *text) override;
    std::string first;
  };

  vtkSmartPointer<vtkOutputWindow> before_;
  vtkNew<Kept> kept_;
};

} // namespace latcon::compare
