#ifndef friction_scene_gmsh_file_h
#define friction_scene_gmsh_file_h

#include <deal.II/base/point.h>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Friction
{
  /**
   * What stands in a file of Gmsh's, formats 2.2 and 4.1, as text or binary, or
   * in one of version 1, which deal.II writes: nodes, elements, physical ids
   * and their names. It is read as it is; what makes a mesh of it, and whether
   * it is a good one, is MeshFile's business.
   *
   * We do not use deal.II's reader, which knows neither binary files nor names,
   * and gives up on much that Gmsh writes by default, interior curves for
   * example, without saying why.
   */
  struct GmshFile
  {
    /** One element with straight edges. */
    struct Element
    {
      std::size_t number = 0;  ///< in the file
      int         physical_id; ///< 0 if it is in no group

      /// Indices of #nodes in the order of Gmsh: around the edge, or around the
      /// lower and then around the upper face.
      std::array<unsigned int, 8> nodes;
    };

    /** The kinds of elements that are kept: Gmsh's numbers. */
    enum Kind
    {
      line          = 1,
      quadrilateral = 3,
      hexahedron    = 5
    };

    /// Coordinates of all nodes, a length.
    std::vector<dealii::Point<3>> nodes;

    /// The elements of the kinds above. One that is in two groups is there
    /// twice.
    std::map<Kind, std::vector<Element>> elements;

    /// How many there are of any other kind, points excepted, by dimension and
    /// by a name of the kind as in "triangles".
    std::map<std::pair<unsigned int, std::string>, std::size_t> others;

    /// Physical ids by dimension and name.
    std::map<std::pair<unsigned int, std::string>, int> names;
  };

  /**
   * Reads such a file. Throws InputError if there is none, if it is in another
   * format, or if it ends too early, with @p where as the beginning of the
   * sentence.
   */
  GmshFile read_gmsh_file(const std::string &path, const std::string &where);
} // namespace Friction

#endif
