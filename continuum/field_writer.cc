#include "continuum/field_writer.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "support/atomic_file.h"
#include "support/pvd.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/stream.hpp>

#include <filesystem>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Computes the fields that are functions of the derivatives of displacement. Four further components, if there are,
// are a stress P_iJ that adds to that of the laws.
class LocalFields : public DataPostprocessor<2>
{
public:
  explicit LocalFields(const Constitution &laws) : laws_(laws) {}

  void evaluate_vector_field(const DataPostprocessorInputs::Vector<2> &inputs,
                             std::vector<Vector<double>> &computed) const override
  {
    for (unsigned int p = 0; p < computed.size(); ++p)
    {
      Tensor<2, 2> F;
      Tensor<3, 2> G;
      for (unsigned int i = 0; i < 2; ++i)
      {
        for (unsigned int J = 0; J < 2; ++J)
          F[i][J] = (i == J ? 1. : 0.) + inputs.solution_gradients[p][i][J];
        G[i] = inputs.solution_hessians[p][i];
      }
      Tensor<2, 2> P = laws_.first_piola_stress(inputs.evaluation_points[p], F, G);
      if (inputs.solution_values[p].size() > 2)
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int J = 0; J < 2; ++J)
            P[i][J] += inputs.solution_values[p](2 + 2 * i + J);
      const Tensor<2, 2> sigma = cauchy_stress(P, F);
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
        {
          computed[p][2 * i + J] = F[i][J];
          computed[p][4 + 2 * i + J] = P[i][J];
          computed[p][8 + 2 * i + J] = sigma[i][J];
        }
      computed[p][12] = laws_.energy(inputs.evaluation_points[p], F, G);
      const Tensor<3, 2> Q = laws_.double_stress(F, G);
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int K = 0; K < 2; ++K)
          {
            computed[p][13 + 4 * i + 2 * J + K] = G[i][J][K];
            computed[p][21 + 4 * i + 2 * J + K] = Q[i][J][K];
          }
    }
  }

  std::vector<std::string> get_names() const override
  {
    std::vector<std::string> names;
    for (const char *tensor : {"deformation_gradient", "first_piola_stress", "cauchy_stress"})
      names.insert(names.end(), 4, tensor);
    names.emplace_back("strain_energy_density");
    for (const char *tensor : {"strain_gradient_x", "strain_gradient_y", "double_stress_x", "double_stress_y"})
      names.insert(names.end(), 4, tensor);
    return names;
  }

  std::vector<DataComponentInterpretation::DataComponentInterpretation>
  get_data_component_interpretation() const override
  {
    std::vector<DataComponentInterpretation::DataComponentInterpretation> kinds(
      12, DataComponentInterpretation::component_is_part_of_tensor);
    kinds.push_back(DataComponentInterpretation::component_is_scalar);
    kinds.insert(kinds.end(), 16, DataComponentInterpretation::component_is_part_of_tensor);
    return kinds;
  }

  UpdateFlags get_needed_update_flags() const override
  {
    return update_values | update_gradients | update_hessians | update_quadrature_points;
  }

private:
  const Constitution &laws_;
};

// Displacement u of a sheet, and a stress that is the polynomial through its values at the Gauss points of a cell.
class StressedSheet
{
public:
  StressedSheet(const Sheet &sheet, const Sheet::Vector &u, const std::vector<Tensor<2, 2>> &stresses)
    : element_(sheet.element(), 1, FE_DGQArbitraryNodes<2>(QGauss<1>(sheet.degree() + 1)), 4), dofs_(sheet.mesh())
  {
    dofs_.distribute_dofs(element_);
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs_, relevant);
    Sheet::Vector values(dofs_.locally_owned_dofs(), sheet.communicator());
    const unsigned int n_points = element_.base_element(1).n_dofs_per_cell();
    const unsigned int n_displacements = sheet.element().n_dofs_per_cell();
    std::vector<types::global_dof_index> of_sheet(n_displacements), own(element_.n_dofs_per_cell());
    std::size_t point = 0;
    for (const auto &cell : dofs_.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        typename DoFHandler<2>::active_cell_iterator(&sheet.mesh(), cell->level(), cell->index(), &sheet.dof_handler())
          ->get_dof_indices(of_sheet);
        cell->get_dof_indices(own);
        for (unsigned int a = 0; a < own.size(); ++a)
        {
          const auto [base, index] = element_.system_to_base_index(a);
          const unsigned int component = base.second; // of the stress
          values(own[a]) = base.first == 0 ? u(of_sheet[index]) : stresses[point + index][component / 2][component % 2];
        }
        point += n_points;
      }
    values.compress(VectorOperation::insert);
    values_.reinit(dofs_.locally_owned_dofs(), relevant, sheet.communicator());
    values_ = values;
  }

  const DoFHandler<2> &dofs() const { return dofs_; }
  const Sheet::Vector &values() const { return values_; }

private:
  FESystem<2> element_;
  DoFHandler<2> dofs_;
  Sheet::Vector values_;
};

template <class Write>
void as_output_failed(const Write &write)
{
  try
  {
    write();
  }
  catch (const support::OutputError &error)
  {
    throw OutputFailed(error.what());
  }
}

void write_whole(const std::filesystem::path &path, const std::string &text)
{
  as_output_failed([&] { support::write_atomically(path, text, support::Sync::no); });
}

// deal.II writes the date in a comment regardless of its flags; equal fields must give equal files.
std::string without_comment(std::string text)
{
  const std::size_t from = text.find("<!--");
  const std::size_t to = text.find("-->\n");
  return from < to && to != std::string::npos ? text.erase(from, to + 4 - from) : text;
}

std::string frame_name(const std::string &name, const std::size_t frame)
{
  std::ostringstream out;
  out << name << "_" << std::setfill('0') << std::setw(4) << frame;
  return out.str();
}

// Writes a VTU text with the time as field data; deal.II's flag for it writes single precision. The text of a large
// sheet is not copied.
void write_with_time(const std::filesystem::path &path, const std::string_view vtu, const double time)
{
  const std::string_view grid = "<UnstructuredGrid>";
  const std::size_t at = vtu.find(grid);
  if (at == std::string_view::npos)
    throw OutputFailed("the VTU text contains no unstructured grid");
  std::ostringstream field;
  field << std::setprecision(17)
        << "\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
        << time << "</DataArray>\n</FieldData>";
  as_output_failed(
    [&]
    {
      support::AtomicFile file(path);
      file.write(vtu.substr(0, at + grid.size()));
      file.write(field.str());
      file.write(vtu.substr(at + grid.size()));
      file.commit(support::Sync::no);
    });
}
} // namespace

FieldWriter::FieldWriter(const MPI_Comm communicator, std::filesystem::path directory, std::string name)
  : communicator_(communicator), directory_(std::move(directory)), name_(std::move(name))
{
  run_collectively(communicator_,
                   [&]
                   {
                     std::error_code failure;
                     std::filesystem::create_directory(directory_, failure);
                     if (failure)
                       throw OutputFailed("cannot create the folder " + directory_.string() + ": " + failure.message());
                   });
}

void FieldWriter::add_frame(const double time, const Sheet &sheet, const Sheet::Vector &u)
{
  add_frame(time, sheet, u, nullptr, {});
}

void FieldWriter::add_frame(const DynamicSolver &solver)
{
  add_frame(solver.time(), solver.sheet(), solver.displacement(), &solver.velocity(), solver.rate_stresses());
}

void FieldWriter::add_frame(const double time, const Sheet &sheet, const Sheet::Vector &u, const Sheet::Vector *v,
                            const std::vector<Tensor<2, 2>> &rate_stresses)
{
  if (!(time > last_time()))
    throw InvalidInput("the time of a frame must be larger than that of the previous frame");

  const std::string frame = frame_name(name_, frames_.size());
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator_);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator_);
  const auto piece = [&](const unsigned int r)
  { return n_ranks == 1 ? frame + ".vtu" : frame + "." + std::to_string(r) + ".vtu"; };

  const LocalFields local_fields(sheet.constitution());
  DataOut<2> output;
  const std::vector<DataComponentInterpretation::DataComponentInterpretation> vector(
    2, DataComponentInterpretation::component_is_part_of_vector);
  DataOutBase::VtkFlags flags;
  flags.compression_level = DataOutBase::VtkFlags::best_speed;
  flags.physical_units = {{"displacement", "m"},         {"velocity", "m/s"},
                          {"deformation_gradient", "1"}, {"first_piola_stress", "Pa"},
                          {"cauchy_stress", "Pa"},       {"strain_energy_density", "J/m^3"},
                          {"strain_gradient_x", "1/m"},  {"strain_gradient_y", "1/m"},
                          {"double_stress_x", "Pa m"},   {"double_stress_y", "Pa m"}};
  flags.print_date_and_time = false; // equal fields give equal files
  flags.write_higher_order_cells = sheet.degree() > 1;
  output.set_flags(flags);
  const std::vector<std::string> names(2, "displacement");
  output.add_data_vector(sheet.dof_handler(), u, names, vector); // communicates, so outside the deferred work
  if (v != nullptr)
    output.add_data_vector(sheet.dof_handler(), *v, std::vector<std::string>(2, "velocity"), vector);
  std::optional<StressedSheet> stressed;
  if (rate_stresses.empty())
    output.add_data_vector(sheet.dof_handler(), u, local_fields);
  else
  {
    stressed.emplace(sheet, u, rate_stresses);
    output.add_data_vector(stressed->dofs(), stressed->values(), local_fields);
  }
  run_collectively(communicator_,
                   [&]
                   {
                     output.build_patches(sheet.mapping(), sheet.degree());
                     std::string text;
                     {
                       boost::iostreams::stream<boost::iostreams::back_insert_device<std::string>> stream(text);
                       output.write_vtu(stream);
                     }
                     write_with_time(directory_ / piece(rank), text, time);
                   });

  frames_.push_back({time, n_ranks});
  if (n_ranks > 1)
    run_collectively(communicator_,
                     [&]
                     {
                       if (rank != 0)
                         return;
                       std::vector<std::string> pieces;
                       for (unsigned int r = 0; r < n_ranks; ++r)
                         pieces.push_back(piece(r));
                       std::ostringstream text;
                       output.write_pvtu_record(text, pieces);
                       write_whole(directory_ / file_of(frames_.size() - 1), without_comment(text.str()));
                     });
  write_collection();
}

void FieldWriter::check_loaded() const
{
  for (std::size_t frame = 0; frame < frames_.size(); ++frame)
    if (frames_[frame].n_pieces == 0 || (frame > 0 && !(frames_[frame].time > frames_[frame - 1].time)))
      throw InvalidInput("the stored times of frames do not increase, or a frame has no pieces");
}

std::string FieldWriter::file_of(const std::size_t frame) const
{
  return frame_name(name_, frame) + (frames_[frame].n_pieces == 1 ? ".vtu" : ".pvtu");
}

void FieldWriter::write_collection() const
{
  run_collectively(communicator_,
                   [&]
                   {
                     if (dealii::Utilities::MPI::this_mpi_process(communicator_) != 0)
                       return;
                     std::vector<support::PvdFile> files;
                     for (std::size_t frame = 0; frame < frames_.size(); ++frame)
                       files.push_back({frames_[frame].time, file_of(frame)});
                     write_whole(collection(), support::pvd_text(files));
                   });
}

double FieldWriter::last_time() const
{
  return frames_.empty() ? -std::numeric_limits<double>::infinity() : frames_.back().time;
}

std::filesystem::path FieldWriter::collection() const
{
  return directory_ / (name_ + ".pvd");
}
} // namespace latcon::continuum
