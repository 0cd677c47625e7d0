#include "continuum/field_writer.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "support/atomic_file.h"
#include "support/full_precision.h"
#include "support/pvd.h"
#include "support/text_wrap.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/stream.hpp>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Computes the fields that are functions of the derivatives of displacement.
class LocalFields : public DataPostprocessor<2>
{
public:
  // @param stresses to be added to those of the laws: the polynomials through their values at the Gauss points of the
  // cells on this rank; empty for none
  LocalFields(const Sheet &sheet, const std::vector<Tensor<2, 2>> &stresses)
    : laws_(sheet.constitution()), stresses_(stresses), first_stress_(sheet.mesh().n_active_cells())
  {
    const FE_DGQArbitraryNodes<2> element(QGauss<1>(sheet.degree() + 1));
    const QIterated<2> points_of_output(QTrapezoid<1>(), sheet.degree());
    interpolation_.reinit(points_of_output.size(), element.n_dofs_per_cell());
    FETools::compute_interpolation_to_quadrature_points_matrix(element, points_of_output, interpolation_);
    std::size_t next = 0;
    for (const auto &cell : sheet.mesh().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
      first_stress_[cell->active_cell_index()] = std::exchange(next, next + element.n_dofs_per_cell());
  }

  void evaluate_vector_field(const DataPostprocessorInputs::Vector<2> &inputs,
                             std::vector<Vector<double>> &computed) const override
  {
    const std::size_t first_stress = first_stress_[inputs.get_cell<2>()->active_cell_index()];
    for (unsigned int p = 0; p < computed.size(); ++p)
    {
      Tensor<2, 2> F(unit_symmetric_tensor<2>());
      Tensor<3, 2> G;
      for (unsigned int i = 0; i < 2; ++i)
      {
        F[i] += inputs.solution_gradients[p][i];
        G[i] = inputs.solution_hessians[p][i];
      }
      std::fill(computed[p].begin(), computed[p].end(), std::numeric_limits<double>::quiet_NaN());
      auto next = computed[p].begin();
      const auto append = [&next](const auto &tensor) { next = std::copy(tensor.begin_raw(), tensor.end_raw(), next); };
      append(F);
      try
      {
        const GradientResponse W = laws_.evaluate(inputs.evaluation_points[p], F, G);
        Tensor<2, 2> P = W.first_piola;
        for (unsigned int k = 0; k < interpolation_.n() && !stresses_.empty(); ++k)
          P += interpolation_(p, k) * stresses_[first_stress + k];
        append(P);
        append(cauchy_stress(P, F));
        *next++ = W.energy;
        append(G);
        append(W.double_stress);
      }
      catch (const NonPhysicalState &) // of a node: det F is positive at quadrature points alone
      {
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
    return update_gradients | update_hessians | update_quadrature_points;
  }

private:
  const Constitution &laws_;
  const std::vector<Tensor<2, 2>> &stresses_;
  std::vector<std::size_t> first_stress_; // of each active cell
  FullMatrix<double> interpolation_;      // from the Gauss points to the points of the output
};

// Replaces a file by the parts of a text. The text of a large sheet is not copied.
void replace(const std::filesystem::path &path, const std::initializer_list<std::string_view> parts)
{
  try
  {
    support::AtomicFile file(path);
    for (const std::string_view part : parts)
      file.write(part);
    file.commit(support::Sync::no);
  }
  catch (const support::OutputError &error)
  {
    throw OutputFailed(error.what());
  }
}

// deal.II writes the date in a comment regardless of its flags; equal fields must give equal files.
std::string without_comment(std::string text)
{
  const std::size_t from = text.find("<!--");
  const std::size_t to = text.find("-->\n");
  return from < to && to != std::string::npos ? text.erase(from, to + 4 - from) : text;
}

// Writes a VTU text with the time as field data; deal.II's flag for it writes single precision.
void write_with_time(const std::filesystem::path &path, const std::string_view vtu, const double time)
{
  const std::string_view grid = "<UnstructuredGrid>";
  const std::size_t at = vtu.find(grid);
  if (at == std::string_view::npos)
    throw OutputFailed("the VTU text contains no unstructured grid");
  const std::string field =
    "\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" +
    support::full_precision(time) + "</DataArray>\n</FieldData>";
  replace(path, {vtu.substr(0, at + grid.size()), field, vtu.substr(at + grid.size())});
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

void FieldWriter::add_frame(const DynamicSolver &solver)
{
  add_frame(solver.time(), solver.sheet(), solver.displacement(), &solver.velocity(), solver.rate_stresses());
}

void FieldWriter::add_frame(const double time, const Sheet &sheet, const Sheet::Vector &u, const Sheet::Vector *v,
                            const std::vector<Tensor<2, 2>> &rate_stresses)
{
  require(time > last_time(), "the time of a frame must be larger than that of the previous frame");

  const std::string frame = frame_name(frames_.size());
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator_);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator_);
  const auto piece = [&](const unsigned int r)
  { return n_ranks == 1 ? frame + ".vtu" : frame + "." + std::to_string(r) + ".vtu"; };

  const LocalFields local_fields(sheet, rate_stresses);
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
  // Communicates, so outside the deferred work.
  output.add_data_vector(sheet.dof_handler(), u, std::vector<std::string>(2, "displacement"), vector);
  if (v != nullptr)
    output.add_data_vector(sheet.dof_handler(), *v, std::vector<std::string>(2, "velocity"), vector);
  output.add_data_vector(sheet.dof_handler(), u, local_fields);
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
  // VTK cannot read a file whose first piece is empty.
  const auto n_cells = dealii::Utilities::MPI::all_gather(communicator_, sheet.mesh().n_locally_owned_active_cells());
  if (n_ranks > 1)
    run_collectively(communicator_,
                     [&]
                     {
                       if (rank != 0)
                         return;
                       std::vector<std::string> pieces;
                       for (unsigned int r = 0; r < n_ranks; ++r)
                         if (n_cells[r] > 0)
                           pieces.push_back(piece(r));
                       std::ostringstream text;
                       output.write_pvtu_record(text, pieces);
                       replace(directory_ / file_of(frames_.size() - 1), {without_comment(text.str())});
                     });
  write_collection();
}

std::string FieldWriter::frame_name(const std::size_t frame) const
{
  return name_ + support::formatted("_%04zu", frame);
}

std::string FieldWriter::file_of(const std::size_t frame) const
{
  return frame_name(frame) + (frames_[frame].n_pieces == 1 ? ".vtu" : ".pvtu");
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
                     replace(collection(), {support::pvd_text(files)});
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
