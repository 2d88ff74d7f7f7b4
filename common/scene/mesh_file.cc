#include <common/input_error.h>
#include <common/parameters/expressions.h>
#include <common/printable.h>
#include <common/scene/mesh_file.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/tensor.h>

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    // Gmsh goes around the edge, deal.II by coordinates.
    constexpr std::array<unsigned int, 8> gmsh_node = {
      {0, 1, 3, 2, 4, 5, 7, 6}};

    // The smallest Jacobian that a cell may have somewhere, relative to the
    // product of the lengths of its edges.
    constexpr double flattest_corner = 1e-6;



    template <typename Array>
    void
    sort_and_unique(std::vector<Array> &list)
    {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }



    // "2 triangles of second order", or "1 triangle of second order".
    std::string
    counted_kind(const std::size_t n, const std::string &kind)
    {
      std::size_t end = kind.find(' ');
      if (end == kind.npos)
        end = kind.size();
      std::string one = kind.substr(0, end);
      if (one.size() > 5 && one.substr(one.size() - 5) == "hedra")
        one.replace(one.size() - 1, 1, "on");
      else
        one.pop_back();
      return counted(n, one + kind.substr(end), kind);
    }



    // Whether a cell goes around its face with the number f, seen from outside,
    // in one sense or in the other: a matter of the order of the vertices, so
    // that its two cells can be compared.
    bool
    sense_around(const std::array<unsigned int, 2> &face, const unsigned int f)
    {
      const bool upwards = face[0] < face[1];
      return (f == 1 || f == 2) ? upwards : !upwards;
    }

    bool
    sense_around(const std::array<unsigned int, 4> &face, const unsigned int f)
    {
      const std::array<unsigned int, 4> cycle = {
        {face[0], face[1], face[3], face[2]}};
      const unsigned int first =
        std::min_element(cycle.begin(), cycle.end()) - cycle.begin();
      const bool upwards = cycle[(first + 1) % 4] < cycle[(first + 3) % 4];
      return f % 2 == 1 ? upwards : !upwards;
    }



    double
    volume(const std::array<Tensor<1, 2>, 2> &edges)
    {
      return edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0];
    }

    double
    volume(const std::array<Tensor<1, 3>, 3> &edges)
    {
      return cross_product_3d(edges[0], edges[1]) * edges[2];
    }
  } // namespace



  template <int dim>
  MeshFile<dim>::MeshFile(const std::string &path, const std::string &where)
    : beginning(where + "the mesh file '" + excerpt(path, 300) + "' ")
  {
    const GmshFile file = read_gmsh_file(path, where);
    check_kinds(file);
    take_cells(file);
    take_vertices(file);
    for (Cell &cell : cells)
      check_cell(cell);
    find_boundary();
    take_groups(file);
  }



  template <int dim>
  void
  MeshFile<dim>::fail(const std::string &what) const
  {
    throw InputError(beginning + what);
  }



  template <int dim>
  std::string
  MeshFile<dim>::place(const Cell &cell) const
  {
    Point<dim> center;
    for (const unsigned int v : cell.vertices)
      center += vertices[v] / double(n_cell_vertices);
    return "number " + std::to_string(cell.number) + " around " +
      coordinates(center);
  }



  template <int dim>
  std::string
  MeshFile<dim>::place(const Face &face) const
  {
    Point<dim> center;
    for (const unsigned int v : face)
      center += vertices[v] / double(n_face_vertices);
    return "around " + coordinates(center);
  }



  template <int dim>
  void
  MeshFile<dim>::check_kinds(const GmshFile &file) const
  {
    const std::string wanted = dim == 2 ? "quadrilaterals" : "hexahedra";
    const auto        count  = [&](const GmshFile::Kind kind) -> std::size_t {
      const auto found = file.elements.find(kind);
      return found == file.elements.end() ? 0 : found->second.size();
    };

    // Volumes in two dimensions; no volumes in three.
    bool has_volumes = count(GmshFile::hexahedron) > 0;
    for (const auto &other : file.others)
      has_volumes |= other.first.first == 3;
    if (dim == 2 && has_volumes)
      fail("is a mesh of three dimensions; give the scene to "
           "step-friction-3d, or save the surface only.");
    for (const auto &other : file.others)
      if (other.first.first == dim)
        fail("has " + counted_kind(other.second, other.first.second) +
             ", but only " + wanted + " of first order are possible here; " +
             (other.first.second.find("order") == std::string::npos
                ? std::string("recombine them in Gmsh (") +
                  (dim == 2 ? "Mesh.RecombineAll"
                            : "extruded or transfinite volumes") +
                  ")."
                : "set Mesh.ElementOrder = 1 in Gmsh."));
    if (dim == 3 && !has_volumes)
      fail(
        count(GmshFile::quadrilateral) > 0
          ? "is a mesh of surfaces only; give the scene to step-friction-2d, "
            "or save the volumes, with a physical volume if anything in it "
            "is physical."
          : "has no volumes; save them, with a physical volume if anything in "
            "it is physical.");
    if (count(dim == 2 ? GmshFile::quadrilateral : GmshFile::hexahedron) == 0)
      fail("has no " + wanted + "; save them, with a physical " +
           (dim == 2 ? "surface" : "volume") +
           " if anything in it is physical.");
  }



  template <int dim>
  void
  MeshFile<dim>::take_cells(const GmshFile &file)
  {
    for (const GmshFile::Element &element : file.elements.at(
           dim == 2 ? GmshFile::quadrilateral : GmshFile::hexahedron))
      {
        Cell cell;
        cell.number      = element.number;
        cell.physical_id = element.physical_id;
        for (unsigned int v = 0; v < n_cell_vertices; ++v)
          cell.vertices[v] = element.nodes[gmsh_node[v]];
        cells.push_back(cell);
      }

    // One that is in two groups comes twice, perhaps numbered in another way.
    const auto sorted = [](const Cell &cell) {
      auto nodes = cell.vertices;
      std::sort(nodes.begin(), nodes.end());
      return nodes;
    };
    std::stable_sort(
      cells.begin(), cells.end(), [&](const Cell &a, const Cell &b) {
        return sorted(a) < sorted(b);
      });
    const auto is_same = [&](const Cell &a, const Cell &b) {
      return sorted(a) == sorted(b);
    };
    for (auto first = cells.begin(); first != cells.end();)
      {
        auto next = first + 1;
        for (; next != cells.end() && is_same(*first, *next); ++next)
          further_ids[first->number].push_back(next->physical_id);
        first = next;
      }
    cells.erase(std::unique(cells.begin(), cells.end(), is_same), cells.end());
    std::sort(cells.begin(), cells.end(), [](const Cell &a, const Cell &b) {
      return a.number < b.number;
    });
  }



  // Only those that cells use, in the order of the file.
  template <int dim>
  void
  MeshFile<dim>::take_vertices(const GmshFile &file)
  {
    constexpr unsigned int    unused = std::numeric_limits<unsigned int>::max();
    std::vector<unsigned int> new_number(file.nodes.size(), unused);
    for (const Cell &cell : cells)
      for (const unsigned int v : cell.vertices)
        new_number[v] = 0;
    double smallest_z = std::numeric_limits<double>::max(),
           largest_z = -smallest_z, size = 0;
    for (unsigned int v = 0; v < file.nodes.size(); ++v)
      if (new_number[v] != unused)
        {
          Point<dim> p;
          for (unsigned int d = 0; d < dim; ++d)
            p[d] = file.nodes[v][d];
          new_number[v] = vertices.size();
          vertices.push_back(p);
          smallest_z = std::min(smallest_z, file.nodes[v][2]);
          largest_z  = std::max(largest_z, file.nodes[v][2]);
          size       = std::max(size, p.distance(vertices[0]));
        }
    if (!(size >= 1. / largest_number && size <= largest_number))
      {
        std::ostringstream text;
        text << "has a size of " << size
             << ", which must be between 1e-30 and 1e30; choose other units.";
        fail(text.str());
      }
    if (dim == 2 && largest_z - smallest_z > 1e-6 * size)
      {
        std::ostringstream text;
        text << "lies in no plane z = constant: its z goes from " << smallest_z
             << " to " << largest_z << "; turn it into the plane of x and y.";
        fail(text.str());
      }
    for (Cell &cell : cells)
      for (unsigned int &v : cell.vertices)
        v = new_number[v];

    // What is left of the file's numbers is in the groups.
    for (const GmshFile::Element &element :
         [&]() -> const std::vector<GmshFile::Element> & {
           static const std::vector<GmshFile::Element> nothing;
           const auto found = file.elements.find(
             dim == 2 ? GmshFile::line : GmshFile::quadrilateral);
           return found == file.elements.end() ? nothing : found->second;
         }())
      {
        if (element.physical_id == 0)
          continue;
        Face face;
        bool is_used = true;
        for (unsigned int v = 0; v < n_face_vertices; ++v)
          {
            face[v] = new_number[element.nodes[v]];
            is_used &= face[v] != unused;
          }
        if (!is_used)
          continue;
        std::sort(face.begin(), face.end());
        groups.emplace_back(face, element.physical_id);
      }
    sort_and_unique(groups);
  }



  // The map to the reference cell is invertible if its Jacobian is positive
  // everywhere.
  template <int dim>
  void
  MeshFile<dim>::check_cell(Cell &cell) const
  {
    const std::string name   = dim == 2 ? "quadrilateral " : "hexahedron ";
    auto              sorted = cell.vertices;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      fail("has a " + name + "with the same node twice, " + place(cell) +
           "; it is a triangle in disguise: mesh that part anew.");

    // The edges in the three directions, and their sizes.
    std::array<double, dim> mean_length{};
    const auto edge = [&](const unsigned int v, const unsigned int d) {
      return vertices[cell.vertices[v | (1u << d)]] -
        vertices[cell.vertices[v & ~(1u << d)]];
    };
    for (unsigned int v = 0; v < n_cell_vertices; ++v)
      for (unsigned int d = 0; d < dim; ++d)
        mean_length[d] += edge(v, d).norm() / n_cell_vertices;

    // Corners, the middles of edges and faces, and that of the cell. In two
    // dimensions the corners would be enough.
    unsigned int n_points = 0, n_positive = 0, n_negative = 0;
    for (unsigned int point = 0; point < (dim == 2 ? 9 : 27); ++point)
      {
        const std::array<double, 3> x = {
          {.5 * (point % 3), .5 * (point / 3 % 3), .5 * (point / 9)}};
        std::array<Tensor<1, dim>, dim> edges;
        double                          lengths = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            for (unsigned int v = 0; v < n_cell_vertices; ++v)
              {
                double weight = .5;
                for (unsigned int c = 0; c < dim; ++c)
                  if (c != d)
                    weight *= (v >> c) % 2 == 1 ? x[c] : 1. - x[c];
                edges[d] += weight * edge(v, d);
              }
            lengths *= std::min(mean_length[d], edges[d].norm());
          }
        const double jacobian = volume(edges);
        ++n_points;
        n_positive += jacobian > flattest_corner * lengths;
        n_negative += jacobian < -flattest_corner * lengths;
      }
    if (n_negative == n_points)
      {
        // Numbered the other way round.
        for (unsigned int v = 0; v < n_cell_vertices / 2; ++v)
          if (dim == 3)
            std::swap(cell.vertices[v], cell.vertices[v + 4]);
        if (dim == 2)
          std::swap(cell.vertices[1], cell.vertices[2]);
      }
    else if (n_negative > 0)
      fail("has a folded " + name + place(cell) +
           ": it is left-handed in some places and not in others; mesh that "
           "part anew.");
    else if (n_positive < n_points)
      fail("has a " + name + "that is flat, or twisted until it is, " +
           place(cell) + "; mesh that part anew.");
  }



  template <int dim>
  void
  MeshFile<dim>::find_boundary()
  {
    // Each face with the sense in which its cell goes around it, and the cell.
    struct Side
    {
      Face         face;
      bool         sense;
      unsigned int cell;
    };
    std::vector<Side> sides;
    sides.reserve(cells.size() * 2 * dim);
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int f = 0; f < 2 * dim; ++f)
        {
          Face face;
          for (unsigned int v = 0; v < n_face_vertices; ++v)
            face[v] =
              cells[c].vertices[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
          const bool sense = sense_around(face, f);
          std::sort(face.begin(), face.end());
          sides.push_back({face, sense, c});
        }
    std::sort(sides.begin(), sides.end(), [](const Side &a, const Side &b) {
      return std::tie(a.face, a.cell) < std::tie(b.face, b.cell);
    });
    for (auto side = sides.begin(); side != sides.end();)
      {
        const auto next =
          std::find_if(side, sides.end(), [&](const Side &other) {
            return other.face != side->face;
          });
        const std::string what = dim == 2 ? "edge " : "face ";
        if (next - side > 2)
          fail("has " + std::to_string(next - side) + " cells that share the " +
               what + place(side->face) + "; cells overlap there.");
        // Neighbours go around their face in opposite directions, unless one of
        // them lies on the other one's side of it.
        if (next - side == 2 && side->sense == (side + 1)->sense)
          fail("has two cells on the same side of the " + what +
               place(side->face) + ", " + place(cells[side->cell]) + " and " +
               place(cells[(side + 1)->cell]) +
               "; one of them is folded over the other.");
        if (next - side == 1)
          boundary.push_back(side->face);
        side = next;
      }
  }



  // groups has all faces with an id; those of them that lie inside are no
  // boundary.
  template <int dim>
  void
  MeshFile<dim>::take_groups(const GmshFile &file)
  {
    std::set<types::boundary_id>                     outer;
    std::vector<std::pair<Face, types::boundary_id>> outer_faces;
    for (const auto &group : groups)
      if (std::binary_search(boundary.begin(), boundary.end(), group.first))
        {
          outer.insert(group.second);
          outer_faces.push_back(group);
        }
    for (const auto &[face, id] : groups)
      if (!std::binary_search(boundary.begin(), boundary.end(), face))
        {
          InnerFaces &inner = inner_faces[id];
          if (++inner.n == 1)
            inner.place = place(face);
          inner.is_whole = outer.count(id) == 0;
        }
    groups.swap(outer_faces);
    for (const auto &[key, id] : file.names)
      if (key.first == dim - 1)
        ids_of_names[key.second] = id;
      else if (key.first == dim)
        ids_of_cell_names[key.second] = id;
  }



  template <int dim>
  int
  MeshFile<dim>::id_of_name(const std::map<std::string, int> &ids,
                            const std::string                &kind,
                            const std::string                &name,
                            const std::string                &where) const
  {
    const auto found = ids.find(name);
    if (found != ids.end())
      return found->second;
    std::string known;
    for (const auto &[other, id] : ids)
      known += (known.empty() ? "'" : ", '") + other + "' (" +
        std::to_string(id) + ")";
    throw InputError(where + ": '" + excerpt(name) +
                     "' is neither a number nor the name of a physical " +
                     kind + " of the mesh file, which has " +
                     (known.empty() ? "no names" : excerpt(known, 300)) +
                     "; correct it.");
  }



  template <int dim>
  types::boundary_id
  MeshFile<dim>::boundary_id(const std::string &name,
                             const std::string &where) const
  {
    return id_of_name(
      ids_of_names, dim == 2 ? "curve" : "surface", name, where);
  }



  template <int dim>
  types::material_id
  MeshFile<dim>::material_id(const std::string &name,
                             const std::string &where) const
  {
    return id_of_name(
      ids_of_cell_names, dim == 2 ? "surface" : "volume", name, where);
  }



  template <int dim>
  double
  MeshFile<dim>::size() const
  {
    return BoundingBox<dim>(vertices).get_boundary_points().first.distance(
      BoundingBox<dim>(vertices).get_boundary_points().second);
  }



  template <int dim>
  bool
  MeshFile<dim>::lies_inside(const types::boundary_id id) const
  {
    const auto inner = inner_faces.find(id);
    return inner != inner_faces.end() && inner->second.is_whole;
  }



  template <int dim>
  int
  MeshFile<dim>::physical_id(
    const Cell &cell, const std::set<types::material_id> &used_materials) const
  {
    const auto further = further_ids.find(cell.number);
    if (further == further_ids.end())
      return cell.physical_id;
    int id = cell.physical_id;
    for (const int other : further->second)
      if (other != id && used_materials.count(other) > 0)
        {
          if (used_materials.count(id) > 0)
            fail("has a cell " + place(cell) + " in the groups " +
                 std::to_string(id) + " and " + std::to_string(other) +
                 ", and the scene speaks of both; let it be in one of them "
                 "only.");
          id = other;
        }
    return id;
  }



  template <int dim>
  void
  MeshFile<dim>::make(const std::set<types::boundary_id> &used_ids,
                      const std::set<types::material_id> &used_materials,
                      Triangulation<dim>                 &triangulation) const
  {
    const auto check_name = [&](const unsigned int id, const auto &ids) {
      const auto other = ids.find(std::to_string(id));
      if (other != ids.end() && other->second != static_cast<int>(id))
        fail("calls its group " + std::to_string(other->second) + " '" +
             other->first + "', and the scene speaks of " + other->first +
             ", which might be either; give the group a name that is no "
             "number.");
    };
    for (const types::boundary_id id : used_ids)
      check_name(id, ids_of_names);
    for (const types::material_id id : used_materials)
      check_name(id, ids_of_cell_names);
    for (const auto &[id, inner] : inner_faces)
      if (used_ids.count(id) > 0 && !inner.is_whole)
        fail("has a group with the physical id " + std::to_string(id) +
             " that lies on the boundary, but " +
             counted(inner.n,
                     dim == 2 ? "edge" : "face",
                     dim == 2 ? "edges" : "faces") +
             " of it inside the body, " + (inner.n == 1 ? "" : "one of them ") +
             inner.place + ", where nothing can be prescribed; take " +
             (inner.n == 1 ? "it" : "them") + " out of the group.");

    std::vector<CellData<dim>> data(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        data[c].vertices.assign(cells[c].vertices.begin(),
                                cells[c].vertices.end());
        data[c].material_id = physical_id(cells[c], used_materials);
      }
    GridTools::consistently_order_cells(data);
    triangulation.create_triangulation(vertices, data, SubCellData());

    for (const auto &cell : triangulation.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          {
            Face key;
            for (unsigned int v = 0; v < n_face_vertices; ++v)
              key[v] = face->vertex_index(v);
            std::sort(key.begin(), key.end());
            // By face, then by id.
            auto group =
              std::lower_bound(groups.begin(),
                               groups.end(),
                               std::make_pair(key, types::boundary_id(0)));
            if (group == groups.end() || group->first != key)
              continue;
            face->set_boundary_id(group->second);
            types::boundary_id used = numbers::invalid_boundary_id;
            for (; group != groups.end() && group->first == key; ++group)
              if (used_ids.count(group->second) > 0)
                {
                  if (used != numbers::invalid_boundary_id)
                    fail("has a face " + place(key) + " in the groups " +
                         std::to_string(used) + " and " +
                         std::to_string(group->second) +
                         ", and the scene speaks of both; let it be in one of "
                         "them only.");
                  used = group->second;
                  face->set_boundary_id(used);
                }
          }
  }



  template class MeshFile<2>;
  template class MeshFile<3>;
} // namespace Friction
