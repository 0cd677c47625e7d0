#include "verification/claims/running_crack/running_crack_claim.h"

#include <cctype>
#include <functional>

#include "support/fits.h"
#include "support/largest_error.h"
#include "verification/bridge/equivalent_sheet.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

constexpr double far_from = 5.;                 // inner radius of the far field [d]
constexpr double near_from = 1.5, near_to = 4.; // annulus of the reported fields near the tip [d]
constexpr double tip_resolution = 0.5;          // of a lattice: half a spacing [d]
constexpr double largest_far_tolerance = 0.07;  // of the far field, whatever the parts of its tolerance
constexpr const char *judged = "local";         // continuum; the others are reported
constexpr const char *at_effective_tip = " continuum with its tip at the effective one against lattice";

// A compared field at a point.
struct Quantity
{
  std::string name;
  std::function<Eigen::Vector2d(const TipValues &)> of;
  bool on_flank = false; // in the row of sites next to the crack, behind the tip, alone; reported
};

const std::vector<Quantity> &quantities()
{
  static const std::vector<Quantity> all{
    {"velocity", [](const TipValues &values) { return values.velocity; }},
    {"opening stress", [](const TipValues &values) { return Eigen::Vector2d(0., values.opening_stress); }},
    {"opening profile", [](const TipValues &values) { return Eigen::Vector2d(0., values.excess.y()); }, true}};
  return all;
}

// An annulus around the tip, in the grid of a drive.
class Region
{
public:
  Region(const CrackDrive &drive, double from, double to)
    : from_(from * drive.spacing), to_(to * drive.spacing), pitch_(drive.pitch())
  {
  }

  // Root mean square of f(point) over the region.
  template <class Function>
  double norm(const TipField &field, const Quantity &quantity, const Function &f) const
  {
    double sum = 0.;
    std::size_t n = 0;
    for (const TipField::Point &point : field.points())
      if (point.radius() >= from_ && point.radius() <= to_ &&
          (!quantity.on_flank || (point.xi < 0. && point.eta < pitch_)))
      {
        sum += f(point).squaredNorm();
        ++n;
      }
    return std::sqrt(sum / static_cast<double>(n)); // NaN without points
  }

  // Distance of a second field from a first one, whose tip is taken to be `shift` [m] ahead, relative to the first.
  double distance(const TipField &first, const TipField &second, const Quantity &quantity, double shift = 0.) const
  {
    return norm(first, quantity,
                [&](const TipField::Point &point) -> Eigen::Vector2d
                { return quantity.of(point.values) - quantity.of(second.at(point.xi - shift, point.eta)); }) /
           norm(first, quantity, [&](const TipField::Point &point) { return quantity.of(point.values); });
  }

private:
  double from_, to_, pitch_;
};

// Shift of the tip of the first field ahead of its nominal position [d] at which the second field is closest to it, to
// a thousandth.
double effective_tip(const TipField &first, const TipField &second, const Region &region, double d)
{
  const auto distance = [&](double shift) { return region.distance(first, second, quantities().front(), shift * d); };
  return support::golden_section(distance, -1.5, 1.5, 1e-3);
}

// Rows and tables of one lattice.
class CrackComparison
{
public:
  CrackComparison(const bridge::Subject &subject, const CrackSides &sides, const RunningCrackOptions &options)
    : rows(outcome.results, "running-crack", subject.name + ", " + state_name(subject.deformation) + ": "),
      subject_(subject), sides_(sides), options_(options), far_(sides.drive, far_from, options.far),
      near_(sides.drive, near_from, near_to), reach_((options.far + 3.) * subject.spacing),
      lattice_(drive_lattice_crack(sides.drive, lattice::without_memory(subject.material), subject.deformation, reach_,
                                   frame("lattice"))) // the continuum has no memories
  {
    add_side("lattice", lattice_);
  }

  void compare(const NamedContinuum &side)
  {
    const std::string &name = side.name;
    const auto drive = [&](double size, const std::optional<CrackFrame> &frame)
    {
      // Cells of about `size` spacings, in strides: a power of two, as the path of the tip is divided.
      CrackMesh mesh{1., options_.degree};
      while (2. * mesh.finest * sides_.drive.stride() < 1.2 * size * sides_.drive.spacing)
        mesh.finest *= 2.;
      return drive_continuum_crack(sides_.drive, sides_.half, side.medium, side.cut, subject_.cauchy_born,
                                   subject_.deformation, mesh, reach_, frame);
    };
    const TipRun coarse = drive(2. * options_.finest, {}), fine = drive(options_.finest, frame(name));
    add_side(name, fine);
    report(name, coarse, fine, judge(name, coarse.field, fine.field));
  }

  ClaimOutcome outcome;
  const Rows rows;

private:
  // Error of the law at the strains of the far field, relative to the stress that drives the motion.
  double anisotropy(const TipField &field) const
  {
    const Quantity all{"", {}};
    const auto first = [](double value) { return Eigen::Vector2d(value, 0.); };
    return far_.norm(field, all, [&](const TipField::Point &point) { return first(point.values.anisotropy); }) /
           far_.norm(field, all, [&](const TipField::Point &point) { return first(point.values.excess_stress); });
  }

  // Returns the effective tip of the lattice [d].
  double judge(const std::string &name, const TipField &coarse, const TipField &fine)
  {
    // The local continuum is judged. At the flanks, and with its gradient energy, it lacks what missing bonds take from
    // a lattice (docs/running-crack.md).
    const bool is_local = name == judged, is_judged = subject_.judges(bridge::Law::mooney_rivlin_network);
    const double d = subject_.spacing, leaves_out = anisotropy(fine);
    const double ahead = effective_tip(lattice_.field, fine, far_, d);
    const std::string annulus = support::text_of(far_from, " d <= r <= ", options_.far, " d");
    for (const Quantity &quantity : quantities())
    {
      const double discretisation = far_.distance(fine, coarse, quantity);
      const double tip = far_.distance(fine, fine, quantity, tip_resolution * d);
      const double error = far_.distance(lattice_.field, fine, quantity);
      const double at_tip = far_.distance(lattice_.field, fine, quantity, ahead * d);
      const output::Tolerance allowed =
        output::limited(discretisation + tip + leaves_out, 0.01, largest_far_tolerance,
                        "change of the mesh, which bounds an error of first order; change by a tip that is d/2 ahead; "
                        "anisotropy of the bonds at the strains of the far field");
      rows.add(quantity.name + ", " + annulus + ", " + name + " continuum against lattice", "1", {}, error,
               is_local && !quantity.on_flank ? allowed : output::Tolerance(), is_judged);
      rows.add(quantity.name + ", " + annulus + ", " + name + at_effective_tip, "1", {}, at_tip);
      outcome
        .table("running_crack_far",
               {"shells", "law", "quantity", "error", "at_effective_tip", "discretisation", "tip", "anisotropy"})
        .add({subject_.name, name, quantity.name, error, at_tip, discretisation, tip, leaves_out});
    }
    const double ahead_of_coarse = effective_tip(lattice_.field, coarse, far_, d);
    const output::Tolerance of_tip =
      output::limited(tip_resolution + std::abs(ahead - ahead_of_coarse), tip_resolution, 0.75,
                      "half a spacing, to which a lattice has a tip; change of the mesh");
    rows.add("effective tip of the lattice ahead of the cut, in d, from the far velocity of the " + name + " continuum",
             "1", of_both(ahead, 0.), std::abs(ahead), is_local ? of_tip : output::Tolerance(), is_judged);
    return ahead;
  }

  // @param ahead effective tip [d]
  void report(const std::string &name, const TipRun &coarse, const TipRun &fine, double ahead)
  {
    const double d = subject_.spacing;
    const std::string annulus = support::text_of(near_from, " d <= r <= ", near_to, " d");
    for (const Quantity &quantity : quantities())
    {
      const std::string where = quantity.name + ", " + annulus + ", " + name + " continuum: ";
      rows.add(where + "against lattice", "1", {}, near_.distance(lattice_.field, fine.field, quantity));
      rows.add(quantity.name + ", " + annulus + ", " + name + at_effective_tip, "1", {},
               near_.distance(lattice_.field, fine.field, quantity, ahead * d));
      rows.add(where + "mesh against one of twice the size", "1", {},
               near_.distance(fine.field, coarse.field, quantity));
    }
    const auto pair = [&](const std::string &what, const std::string &unit, double lattice, double continuum)
    {
      rows.add(what + ", " + name + " continuum", unit, of_both(lattice, continuum),
               support::relative_error(continuum, lattice));
    };
    const double limit = 0.01 * sides_.drive.speed * subject_.deformation(0, 0), reach = options_.far * d;
    const analysis::NegativeZone of_lattice = negative_zone(lattice_.field, limit, reach);
    const analysis::NegativeZone zone = negative_zone(fine.field, limit, reach);
    pair("backward motion ahead of the tip, r <= far field: area over d^2", "1", 2. * of_lattice.area / (d * d),
         2. * zone.area / (d * d));
    pair("backward motion ahead of the tip: most negative velocity", "m/s", of_lattice.depth, zone.depth);
    constexpr double radius = 3.;
    const analysis::OpeningStress lattice = opening_stress(lattice_.field, radius * d),
                                  continuum = opening_stress(fine.field, radius * d);
    const std::string at = support::text_of(" at r = ", radius, " d");
    pair("opening stress straight ahead" + at, "Pa", lattice_.field.at(radius * d, 0.).opening_stress,
         fine.field.at(radius * d, 0.).opening_stress);
    pair("lobes of the opening stress, largest over straight ahead" + at, "1", lattice.ratio, continuum.ratio);
    rows.add("lobes of the opening stress, angle of the largest" + at + ", " + name + " continuum", "deg",
             of_both(lattice.angle, continuum.angle), std::abs(lattice.angle - continuum.angle));
    pair("energy lost by the sheet per length of crack", "J/m^2", lattice_.energy.lost, fine.energy.lost);
    pair("energy dissipated by viscosity per length of crack", "J/m^2", lattice_.energy.dissipated,
         fine.energy.dissipated);
    pair("energy of cut bonds, and what the opening edge takes, per length of crack", "J/m^2", lattice_.energy.taken,
         fine.energy.taken);
    pair("energy flux into r <= 5 d: cut and dissipated there, per length of crack", "J/m^2",
         lattice_.energy.taken + lattice_.energy.near, fine.energy.taken + fine.energy.near);
  }

  std::optional<CrackFrame> frame(const std::string &side) const
  {
    if (options_.frames.empty())
      return {};
    std::string name = "crack-";
    for (const unsigned char c : subject_.name)
      name += std::isalnum(c) != 0 ? static_cast<char>(std::tolower(c)) : '-';
    return CrackFrame{options_.frames, name + "-" + side};
  }

  void add_side(const std::string &side, const TipRun &run)
  {
    if (const std::optional<CrackFrame> drawn = frame(side))
      outcome.table("running_crack_frames", {"shells", "side", "file", "X_tip [m]", "Y_tip [m]"})
        .add({subject_.name, side, drawn->name + ".pvd", sides_.drive.end(), sides_.drive.axis()});
    output::Table &table = outcome.table("running_crack", {"shells", "side", "X/d", "Y/d", "v_x [m/s]", "v_y [m/s]",
                                                           "opening_stress [Pa]", "excess_y [m]"});
    for (const TipField::Point &point : run.field.points())
      table.add({subject_.name, side, point.xi / subject_.spacing, point.eta / subject_.spacing,
                 point.values.velocity.x(), point.values.velocity.y(), point.values.opening_stress,
                 point.values.excess.y()});
  }

  const bridge::Subject &subject_;
  const CrackSides &sides_;
  RunningCrackOptions options_;
  Region far_, near_;
  double reach_;
  TipRun lattice_;
};

} // namespace

CrackSides crack_sides(const bridge::Subject &subject, const RunningCrackOptions &options)
{
  const double d = subject.spacing;
  CrackDrive drive{d, subject.orientation, options.length * d, options.height * d, 0., 0., 0};
  drive.start_near(options.start * d);
  drive.n_strides = static_cast<unsigned int>(std::lround(options.advance * d / drive.stride()));
  const Eigen::Vector2d K(1. / d, 0.);
  const SubjectContinua media(subject);
  const auto waves = continuum_waves(media.network, subject.deformation, K);
  drive.speed = 0.5 * support::smallest_of({waves[0].frequency, waves[1].frequency}) / K.norm();

  const lattice::TriangularLattice sheet(d, drive.length, drive.height, drive.orientation);
  const double end_depth = bridge::held_depth(sheet, subject.material, {1., 0.});
  const std::shared_ptr<const continuum::Viscosity> viscosity = bridge::homogenised_viscosity(sheet, subject.material),
                                                    of_gradient = bridge::homogenised_viscosity(
                                                      sheet, subject.material, subject.lengths.lattice);
  CrackSides sides{drive,
                   {end_depth, sheet.length() - end_depth,
                    0.5 * sheet.height() - bridge::held_depth(sheet, subject.material, {0., 1.})},
                   {}};
  const std::vector<continuum::BondFamily> bonds = bridge::bond_families(sheet, subject.material);
  const auto add = [&](const std::string &prefix, WaveContinuum local, WaveContinuum gradient)
  {
    local.viscosity = gradient.viscosity = viscosity;
    sides.continua.push_back({prefix + "local", local});
    sides.continua.push_back({prefix + "gradient", gradient});
    sides.continua.push_back({prefix + "local-flank", local, bonds});
    sides.continua.push_back({prefix + "gradient-flank", gradient, bonds});
    gradient.viscosity = of_gradient;
    sides.continua.push_back({prefix + "viscous-gradient", gradient});
  };
  add("", media.network, media.network_gradient);
  if (options.anisotropic)
    add("bonds-", media.local, media.gradient);
  return sides;
}

ClaimOutcome running_crack_claim(const bridge::Subject &subject, const RunningCrackOptions &options)
{
  ClaimOutcome outcome;
  const Eigen::Matrix2d &F = subject.deformation;
  constexpr double least_opening = 0.01;
  if (!subject.is_stable())
    outcome.results.add(stability_row(subject, "running-crack"));
  else if (F(0, 1) != 0. || F(1, 0) != 0. || !(F(1, 1) > 1. + least_opening))
    Rows(outcome.results, "running-crack", subject.name + ", " + state_name(F) + ": ")
      .add("no crack is compared, the sheet is sheared or not stretched across it", "1", {});
  else
    return running_crack_claim(subject, crack_sides(subject, options), options);
  return outcome;
}

ClaimOutcome running_crack_claim(const bridge::Subject &subject, const CrackSides &sides,
                                 const RunningCrackOptions &options)
{
  CrackComparison comparison(subject, sides, options);
  for (const NamedContinuum &side : sides.continua)
  {
    const auto compare = [&] { comparison.compare(side); };
    if (side.name == judged)
    {
      comparison.rows.attempt(side.name + " continuum", compare);
      continue;
    }
    // Reported: so is a computation that does not succeed, without the report of its solver.
    output::Results failure;
    if (!failure.attempt("running-crack", side.name + " continuum", compare))
    {
      const std::string reason = failure.rows().front().quantity;
      comparison.rows.add(reason.substr(0, reason.find('\n')), "1", {});
    }
  }
  return comparison.outcome;
}

ClaimOutcome check_running_crack(const ClaimInput &input)
{
  RunningCrackOptions options;
  if (!input.quick)
    options = {66., 48., 18., 30., 12., 0.5, 3, true, {}};
  options.frames = input.frames;
  return running_crack_claim(input.subject, options);
}

} // namespace latcon::claims
