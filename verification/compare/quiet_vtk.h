#pragma once

#include <string>

#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace latcon::compare
{

/// Redirects error messages of VTK from the terminal to this object in its scope. Not thread-safe.
class QuietVtk
{
public:
  QuietVtk();
  ~QuietVtk();
  QuietVtk(const QuietVtk &) = delete;
  QuietVtk &operator=(const QuietVtk &) = delete;

  /// Returns the first error without its position in the sources of VTK; empty if there was none.
  std::string error() const;

private:
  // Stores the first error.
  class FirstErrorWindow : public vtkOutputWindow
  {
  public:
    static FirstErrorWindow *New();
    void DisplayText(const char *) override {}
    void DisplayErrorText(const char *text) override;
    std::string first;
  };

  vtkSmartPointer<vtkOutputWindow> before_;
  vtkNew<FirstErrorWindow> kept_;
};

} // namespace latcon::compare
