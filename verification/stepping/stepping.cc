// The lattice of a case, stepped from Python: the module latcon_stepping, which python/latcon/stepping.py wraps.
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "lattice/simulation.h"
#include "support/errors.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/output/archive.h"

namespace py = pybind11;

namespace latcon::stepping
{
namespace
{

// Sheet of a case with its seed crack. Arrays are views of its fields, over all places; sites() has those that are sites.
class Sheet
{
public:
  Sheet(const std::string &case_text, bool on_continuum)
  {
    input::Parameters parameters;
    input_.declare(parameters);
    parameters.read_text(case_text, "case");
    input_.nonlocal.is_used = on_continuum;
    input_.check(parameters);
    bridge::require_fracture_case(input_, parameters);
    parameters.finish();
    lattice_ = std::make_unique<lattice::TriangularLattice>(input_.sheet());
    band_ = std::make_unique<lattice::RowPartition>(*lattice_);
    simulation_ = input::cracked_sheet(input_, *band_);
    if (input_.history.empty())
      edges_ = simulation_->constrain({lattice::held_sites(simulation_->state(), *lattice_)});
  }

  void move_edges(const Eigen::Matrix2d &velocity_gradient)
  {
    if (!edges_)
      throw std::invalid_argument("the edges move by the history of the case");
    simulation_->set_motion(*edges_, lattice::steady(velocity_gradient));
  }

  // Bonds that broke: (time, site, other site, X, Y, stretch).
  using Broken = std::vector<std::tuple<double, std::size_t, std::size_t, double, double, double>>;
  Broken step(std::size_t n)
  {
    Broken broken;
    for (std::size_t i = 0; i < n; ++i)
      for (const lattice::BrokenBond &bond : simulation_->step())
        broken.emplace_back(bond.time, bond.near, bond.far, bond.X, bond.Y, bond.stretch);
    return broken;
  }

  // Places of the sites that were not removed, by row.
  py::array sites() const
  {
    std::vector<std::size_t> found;
    for (std::size_t place = 0; place < lattice_->n_places(); ++place)
      if (lattice_->is_site(place) && simulation_->state().removed[place] == 0)
        found.push_back(place);
    return py::array_t<std::size_t>(found.size(), found.data());
  }

  // Returns the places at the ends of each unbroken bond, and its stretch.
  py::tuple bonds() const
  {
    const lattice::State &state = simulation_->state();
    std::vector<std::size_t> ends;
    std::vector<double> stretches;
    lattice::for_each_bond(state, *lattice_,
                           [&](const lattice::Bond &bond)
                           {
                             ends.insert(ends.end(), {bond.near, bond.far});
                             stretches.push_back(lattice::stretch(state, *lattice_, bond));
                           });
    return py::make_tuple(pairs(ends), py::array_t<double>(stretches.size(), stretches.data()));
  }

  // Undeformed position of each place [m].
  py::array reference() const
  {
    std::vector<double> found;
    for (std::size_t place = 0; place < lattice_->n_places(); ++place)
      found.insert(found.end(), {lattice_->reference(place).x(), lattice_->reference(place).y()});
    return pairs(found);
  }

  // Adds impulses per sheet thickness over the masses of the sites to their velocities.
  void kick(const std::vector<double> &px, const std::vector<double> &py)
  {
    const std::size_t n = lattice_->n_places();
    if (px.size() != n || py.size() != n)
      throw std::invalid_argument("impulses are needed for all " + std::to_string(n) + " places");
    lattice::VectorField velocity = simulation_->state().velocity;
    for (std::size_t place = 0; place < n; ++place)
      velocity.add(place, simulation_->state().inverse_mass[place] * Eigen::Vector2d(px[place], py[place]));
    simulation_->set_velocities(velocity, false);
  }

  std::map<std::string, double> energies() const
  {
    const lattice::EnergyBalance energies = simulation_->energies();
    return {{"elastic", energies.elastic},      {"kinetic", energies.kinetic},
            {"viscous", energies.viscous},      {"broken", energies.broken},
            {"contact", energies.contact},      {"boundary_work", energies.boundary_work},
            {"imbalance", energies.imbalance()}};
  }

  // Returns the content of a checkpoint.
  py::bytes save()
  {
    output::Hdf5Image image;
    output::CheckpointWriter archive(&image);
    simulation_->archive(archive);
    return image.take_bytes();
  }
  void load(const std::string &file)
  {
    const output::Hdf5File stored(file);
    output::CheckpointReader archive(stored);
    simulation_->archive(archive);
  }

  lattice::Simulation &simulation() { return *simulation_; }

private:
  template <class T>
  static py::array pairs(const std::vector<T> &values)
  {
    return py::array_t<T>({values.size() / 2, std::size_t{2}}, values.data());
  }

  input::Case input_;
  std::unique_ptr<lattice::TriangularLattice> lattice_;
  std::unique_ptr<lattice::RowPartition> band_;
  std::unique_ptr<lattice::Simulation> simulation_;
  std::optional<std::size_t> edges_; // constraint that the caller moves
};

// View of a field of a state, which cannot be written.
template <class Field>
auto view(const Field &field)
{
  return [field](py::object self)
  {
    const auto &values = std::invoke(field, self.cast<Sheet &>().simulation().state());
    py::array_t<std::decay_t<decltype(values[0])>> array(values.size(), values.data(), self);
    array.attr("flags").attr("writeable") = false;
    return array;
  };
}

} // namespace

PYBIND11_MODULE(latcon_stepping, module)
{
  py::register_exception_translator(
    [](std::exception_ptr error)
    {
      try
      {
        std::rethrow_exception(error);
      }
      catch (const support::InputError &problem)
      {
        PyErr_SetString(PyExc_ValueError, problem.what());
      }
      catch (const output::Hdf5Error &problem)
      {
        PyErr_SetString(PyExc_ValueError, problem.what());
      }
    });
  const py::call_guard<py::gil_scoped_release> without_lock;
  py::class_<Sheet>(module, "Sheet")
    .def(py::init<const std::string &, bool>())
    .def("step", &Sheet::step, without_lock)
    .def("kick", &Sheet::kick)
    .def("move_edges", &Sheet::move_edges)
    .def("save", &Sheet::save)
    .def("load", &Sheet::load)
    .def("sites", &Sheet::sites)
    .def("bonds", &Sheet::bonds)
    .def("reference", &Sheet::reference)
    .def_property_readonly("x", view([](const lattice::State &state) -> const auto & { return state.position.x; }))
    .def_property_readonly("y", view([](const lattice::State &state) -> const auto & { return state.position.y; }))
    .def_property_readonly("vx", view([](const lattice::State &state) -> const auto & { return state.velocity.x; }))
    .def_property_readonly("vy", view([](const lattice::State &state) -> const auto & { return state.velocity.y; }))
    .def_property_readonly("lost_bonds", view(&lattice::State::lost_bonds))
    .def_property_readonly("time", [](Sheet &sheet) { return sheet.simulation().state().time; })
    .def_property_readonly("time_step", [](Sheet &sheet) { return sheet.simulation().time_step(); })
    .def_property_readonly("tip", [](Sheet &sheet) { return sheet.simulation().tip(); })
    .def_property_readonly("energies", &Sheet::energies);
}

} // namespace latcon::stepping
