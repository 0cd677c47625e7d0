#include "verification/compare/quiet_vtk.h"

#include <vtkLogger.h>

namespace latcon::compare
{

// VTK writes messages to both its output window and its log.
QuietVtk::QuietVtk() : before_(vtkOutputWindow::GetInstance())
{
  vtkOutputWindow::SetInstance(kept_);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

QuietVtk::~QuietVtk()
{
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_WARNING);
  vtkOutputWindow::SetInstance(before_);
}

QuietVtk::FirstErrorWindow *QuietVtk::FirstErrorWindow::New()
{
  auto *const window = new FirstErrorWindow;
  window->InitializeObjectBase();
  return window;
}

void QuietVtk::FirstErrorWindow::DisplayErrorText(const char *text)
{
  if (first.empty())
    first = text == nullptr ? "unknown error" : text;
}

std::string QuietVtk::error() const
{
  // "ERROR: In FILE, line N\nvtkClass (0xADDRESS): what is wrong\n\n"
  std::string text = kept_->first;
  const std::size_t place = text.find("): ");
  if (place != std::string::npos)
    text.erase(0, place + 3);
  for (char &c : text)
    if (c == '\n')
      c = ' ';
  while (!text.empty() && text.back() == ' ')
    text.pop_back();
  return text;
}

} // namespace latcon::compare
