// Gmsh 4.8 manual, "MSH file format". GridIn of deal.II ignores names, takes lines without a number for number 0, and
// drops z.
#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/meshes.h"
#include "support/text_wrap.h"

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
constexpr std::size_t largest_file = std::size_t{256} << 20;
constexpr std::array edge_names{"left", "right", "bottom", "top", "inner"};
const std::string expected_curves = "; expected 0 (left), 1 (right), 2 (bottom), 3 (top) or 4 (inner), or these names";

enum Kind
{
  line = 1, // also the dimension of a curve
  quadrilateral = 3,
  point = 15
};

// Nodes [m], quadrilaterals, and lines with the boundary ids of continuum::edge.
struct GmshMesh
{
  std::vector<Point<2>> points;
  std::vector<CellData<2>> cells;
  SubCellData lines;
};

template <class... Parts>
[[noreturn]] void refuse(const Parts &...parts)
{
  throw InvalidInput(support::text_of(parts...)); // to be preceded by the name of the file
}

struct Element
{
  std::size_t number;
  int kind;
  std::set<int> numbers; // of the physical curve or surface
  std::array<std::size_t, 4> nodes;
};

// Reads the words of a file one after the other.
class Reader
{
public:
  explicit Reader(std::istream &stream) : stream_(stream) {}

  template <class Value>
  Value next(const char *what)
  {
    Value value{};
    if (!(stream_ >> value))
    {
      stream_.clear();
      std::string word;
      stream_ >> word;
      if (word.empty())
        refuse("ends in ", section_, " where ", what, " is expected");
      refuse("has '", word.substr(0, 20), "' in ", section_, " where ", what, " is expected");
    }
    return value;
  }

  // Goes on to the next section; returns its name, empty at the end of the file.
  std::string section()
  {
    std::string word;
    while (stream_ >> word)
      if (word[0] == '$' && word.compare(0, 4, "$End") != 0)
        return section_ = word;
    return "";
  }

  // Goes on to the end of $Comments and other text, in which $ may begin a word.
  void skip_section()
  {
    const std::string end = "$End" + section_.substr(1);
    for (std::string word; stream_ >> word && word != end;)
      ;
  }

  void skip_line() { stream_.ignore(std::numeric_limits<std::streamsize>::max(), '\n'); }

  std::string quoted()
  {
    std::string name;
    stream_ >> std::quoted(name, '"', '\0');
    return name;
  }

private:
  std::istream &stream_;
  std::string section_ = "$MeshFormat";
};

class MshFile
{
public:
  explicit MshFile(std::istream &stream) : read_(stream)
  {
    std::string first;
    while ((first = read_.section()) == "$Comments")
      read_.skip_section();
    if (first != "$MeshFormat")
      refuse("is not a mesh of Gmsh (.msh, version 2 or 4.1, ASCII): it does not begin with $MeshFormat");
    const std::string version = read_.next<std::string>("a version");
    if (read_.next<int>("0 or 1") != 0)
      refuse("is binary; save it as ASCII");
    is_2_ = version.compare(0, 2, "2.") == 0 || version == "2";
    if (!is_2_ && version != "4.1")
      refuse("has the format version ", version.substr(0, 20), ", which is not supported; save it as version 2 or 4.1");
    for (std::string name; !(name = read_.section()).empty();)
      if (name == "$PhysicalNames")
        read_names();
      else if (name == "$Entities" && !is_2_)
        read_entities();
      else if (name == "$Nodes")
        read_nodes();
      else if (name == "$Elements")
        read_elements();
      else
        read_.skip_section();
  }

  GmshMesh mesh() const
  {
    GmshMesh mesh;
    std::map<std::size_t, unsigned int> index; // of nodes of cells
    double lowest = std::numeric_limits<double>::max(), highest = -lowest, extent = 0.;
    bool has_numbers = false;
    for (const auto &[element, kind, numbers, nodes] : elements_)
    {
      if (kind != quadrilateral)
        continue;
      has_numbers = has_numbers || numbers != std::set<int>{0};
      CellData<2> cell(4);
      for (unsigned int k = 0; k < 4; ++k)
      {
        const auto [entry, is_new] = index.emplace(nodes[k], mesh.points.size());
        if (is_new)
        {
          const auto node = nodes_.find(nodes[k]);
          if (node == nodes_.end())
            refuse("has an element ", element, " with the node ", nodes[k], ", which is not in the file");
          const Point<3> &X = node->second;
          mesh.points.emplace_back(X[0], X[1]);
          lowest = std::min(lowest, X[2]);
          highest = std::max(highest, X[2]);
          extent = std::max({extent, std::abs(X[0] - mesh.points[0][0]), std::abs(X[1] - mesh.points[0][1])});
        }
        cell.vertices[k] = entry->second;
      }
      orient(cell, element, mesh.points);
      mesh.cells.push_back(cell);
    }
    if (mesh.cells.empty())
      refuse("contains no cells (quadrilaterals)");
    constexpr double round_off = 1e-12; // of coordinates that were rotated or converted to decimals
    if (!(highest - lowest <= round_off * extent))
      refuse("has nodes at z = ", lowest, " and ", highest, " m; it must lie in a plane z = const");
    if (is_2_ && !has_numbers)
      refuse("has no physical groups, or was saved with `Save all elements`, which drops them: assign the surface to a "
             "physical surface, its boundary to physical curves, and save without that option");
    add_lines(mesh, index);
    return mesh;
  }

private:
  void read_names()
  {
    const auto n = read_.next<std::size_t>("a number of names");
    for (std::size_t i = 0; i < n; ++i)
    {
      const int dimension = read_.next<int>("a dimension"), number = read_.next<int>("a physical number");
      const std::string name = read_.quoted();
      if (dimension != line)
        continue;
      const auto [known, is_first] = names_.emplace(number, name);
      if (!is_first && known->second != name)
        refuse("gives the physical curve ", number, " two names, \"", known->second, "\" and \"", name, "\"");
    }
  }

  void read_entities()
  {
    std::size_t n[4];
    for (std::size_t &count : n)
      count = read_.next<std::size_t>("a number of entities");
    read_.skip_line();
    for (std::size_t i = 0; i < n[0]; ++i)
      read_.skip_line();
    for (int dimension = 1; dimension < 3; ++dimension)
      for (std::size_t i = 0; i < n[dimension]; ++i)
      {
        const int entity = read_.next<int>("the number of an entity");
        for (int side = 0; side < 6; ++side)
          (void)read_.next<double>("a coordinate");
        const auto n_numbers = read_.next<std::size_t>("a number of physical groups");
        for (std::size_t k = 0; k < n_numbers; ++k)
          numbers_[{dimension, entity}].insert(read_.next<int>("a physical number"));
        read_.skip_line();
      }
    read_.skip_section();
  }

  // Version 2 has no blocks.
  std::size_t n_blocks()
  {
    if (is_2_)
      return 1;
    const auto n = read_.next<std::size_t>("a number of blocks");
    read_.skip_line();
    return n;
  }

  void read_nodes()
  {
    for (std::size_t blocks = n_blocks(); blocks > 0; --blocks)
    {
      if (!is_2_)
      {
        for (int i = 0; i < 2; ++i)
          (void)read_.next<int>("an entity");
        if (read_.next<int>("0 or 1") != 0)
          refuse("has parametric nodes; save it without them");
      }
      const auto n = read_.next<std::size_t>("a number of nodes");
      std::vector<std::size_t> numbers;
      for (std::size_t i = 0; i < n && !is_2_; ++i)
        numbers.push_back(read_.next<std::size_t>("the number of a node"));
      for (std::size_t i = 0; i < n; ++i)
      {
        Point<3> &X = nodes_[is_2_ ? read_.next<std::size_t>("the number of a node") : numbers[i]];
        for (unsigned int k = 0; k < 3; ++k)
          X[k] = read_.next<double>("a coordinate");
      }
    }
  }

  void read_elements()
  {
    for (std::size_t blocks = n_blocks(); blocks > 0; --blocks)
    {
      Element element{};
      if (!is_2_)
      {
        const int dimension = read_.next<int>("a dimension"), entity = read_.next<int>("an entity");
        element.kind = read_.next<int>("the type of elements");
        element.numbers = numbers_[{dimension, entity}];
      }
      const auto n = read_.next<std::size_t>("a number of elements");
      for (std::size_t i = 0; i < n; ++i)
      {
        element.number = read_.next<std::size_t>("the number of an element");
        if (is_2_)
        {
          element.kind = read_.next<int>("the type of an element");
          element.numbers.clear();
          const auto n_tags = read_.next<std::size_t>("a number of tags");
          for (std::size_t k = 0; k < n_tags; ++k)
            if (const int tag = read_.next<int>("a tag"); k == 0)
              element.numbers.insert(tag);
        }
        const int kind = element.kind;
        if (kind != line && kind != quadrilateral && kind != point)
          refuse("has an element ", element.number, " of type ", kind,
                 kind == 2 ? ", a triangle; generate quadrilaterals with Gmsh's `Recombine Surface`"
                           : "; expected lines and quadrilaterals of first order (`Mesh.ElementOrder = 1`)");
        for (int k = 0; k < (kind == line ? 2 : kind == point ? 1 : 4); ++k)
          element.nodes[k] = read_.next<std::size_t>("the number of a node");
        elements_.push_back(element);
      }
    }
  }

  // Turns the corners from the order of Gmsh, around the cell, into that of deal.II.
  static void orient(CellData<2> &cell, const std::size_t number, const std::vector<Point<2>> &points)
  {
    auto &v = cell.vertices;
    int turns = 0; // left ones less right ones
    for (unsigned int k = 0; k < 4; ++k)
    {
      const Tensor<1, 2> before = points[v[k]] - points[v[(k + 3) % 4]], after = points[v[(k + 1) % 4]] - points[v[k]];
      const double turn = before[0] * after[1] - before[1] * after[0];
      turns += (turn > 0.) - (turn < 0.);
    }
    if (std::abs(turns) != 4)
      refuse("has a cell that is not convex, element ", number, " with a corner at (", points[v[0]][0], ", ",
             points[v[0]][1], ") m: its Jacobian vanishes or changes sign");
    if (turns < 0)
      std::swap(v[1], v[3]);
    std::swap(v[2], v[3]);
  }

  // Returns the boundary id of a physical curve; by their names where any has one, as Gmsh chooses the numbers then.
  types::boundary_id edge_of(const std::string &where, const std::set<int> &numbers) const
  {
    if (numbers.empty())
      refuse("has ", where, " on no physical curve", expected_curves);
    if (numbers.size() > 1)
      refuse("has ", where, " on several physical curves", expected_curves);
    const int number = *numbers.begin();
    const int id = names_.empty() ? number : edge_named(number);
    if (id < 0 || id >= static_cast<int>(edge_names.size()))
      refuse("has ", where, " on the physical curve ", number,
             names_.count(number) > 0 ? " named \"" + names_.at(number) + "\""
             : names_.empty()         ? ""
                                      : " without a name, among others with one",
             expected_curves);
    return id;
  }

  // Returns the boundary id that the name of a curve gives it, -1 for none.
  int edge_named(const int curve) const
  {
    const auto name = names_.find(curve);
    for (std::size_t id = 0; id < edge_names.size(); ++id)
      if (name != names_.end() && name->second == edge_names[id])
        return static_cast<int>(id);
    return -1;
  }

  void add_lines(GmshMesh &mesh, const std::map<std::size_t, unsigned int> &index) const
  {
    std::set<std::pair<unsigned int, unsigned int>> sides; // of cells, all of them anticlockwise
    for (const CellData<2> &cell : mesh.cells)
      for (const auto &[a, b] : {std::pair(0, 1), {1, 3}, {3, 2}, {2, 0}})
        if (!sides.emplace(cell.vertices[a], cell.vertices[b]).second)
          refuse("has cells that overlap, at (", mesh.points[cell.vertices[a]][0], ", ",
                 mesh.points[cell.vertices[a]][1], ") m; is a surface in two physical surfaces?");
    std::map<std::pair<unsigned int, unsigned int>, std::set<int>> numbers;
    for (const Element &element : elements_)
      if (element.kind == line)
      {
        if (element.numbers.empty())
          refuse("has lines on no physical curve, as element ", element.number, expected_curves);
        const auto a = index.find(element.nodes[0]), b = index.find(element.nodes[1]);
        if (a != index.end() && b != index.end())
          numbers[std::minmax(a->second, b->second)].insert(element.numbers.begin(), element.numbers.end());
      }
    const auto line_between = [&mesh](const unsigned int first, const unsigned int second)
    {
      const Point<2> &from = mesh.points[first], &to = mesh.points[second];
      return support::text_of(" from (", from[0], ", ", from[1], ") to (", to[0], ", ", to[1], ") m");
    };
    // A load on such a line would be left out.
    for (const auto &[ends, curves] : numbers)
      if (sides.count(ends) == sides.count({ends.second, ends.first}))
        for (const int curve : curves)
          if (edge_named(curve) >= 0)
            refuse("has a line", line_between(ends.first, ends.second), ", not on the boundary, on the physical curve ",
                   curve, " named \"", names_.at(curve), "\", which is the name of an edge");
    for (const auto &[first, second] : sides)
    {
      if (sides.count({second, first}) > 0)
        continue;
      const std::pair<unsigned int, unsigned int> ends = std::minmax(first, second);
      const std::string where = "an edge" + line_between(ends.first, ends.second);
      CellData<1> side(2);
      side.vertices = {first, second};
      side.boundary_id = edge_of(where, numbers[ends]);
      mesh.lines.boundary_lines.push_back(side);
    }
  }

  Reader read_;
  bool is_2_ = false;
  std::map<int, std::string> names_;                     // of physical curves
  std::map<std::pair<int, int>, std::set<int>> numbers_; // physical numbers of an entity; dimension and number
  std::map<std::size_t, Point<3>> nodes_;
  std::vector<Element> elements_;
};

GmshMesh read_gmsh_file(const std::filesystem::path &file)
{
  const std::string name = "the mesh file " + file.string();
  std::error_code error;
  // Others, such as devices, may be endless.
  if (std::filesystem::exists(file, error) &&
      !(std::filesystem::is_regular_file(file, error) && std::filesystem::file_size(file, error) <= largest_file))
    throw InvalidInput(name + " is not a regular file of at most 256 MiB");
  std::ifstream stream(file);
  if (!stream)
    throw InvalidInput("cannot read " + name + " from the folder " + std::filesystem::current_path(error).string());
  try
  {
    return MshFile(stream).mesh();
  }
  catch (const InvalidInput &defect)
  {
    throw InvalidInput(name + " " + defect.what());
  }
}
} // namespace

double n_coarse_cells(const std::filesystem::path &gmsh_file)
{
  return read_gmsh_file(gmsh_file).cells.size();
}

void read_gmsh(parallel::distributed::Triangulation<2> &mesh, const std::filesystem::path &file,
               const unsigned int refinements)
{
  GmshMesh read;
  // An exception on one rank must not leave the others waiting.
  run_collectively(mesh.get_communicator(), [&] { read = read_gmsh_file(file); });
  GridTools::consistently_order_cells(read.cells);
  mesh.create_triangulation(read.points, read.cells, read.lines);
  mesh.refine_global(refinements);
}
} // namespace latcon::continuum
