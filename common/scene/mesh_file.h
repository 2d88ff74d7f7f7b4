#ifndef friction_scene_mesh_file_h
#define friction_scene_mesh_file_h

#include <common/scene/gmsh_file.h>

#include <deal.II/base/types.h>

#include <deal.II/grid/tria.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Friction
{
  /**
   * A mesh of Gmsh's as a body: its cells, and the physical ids of its
   * boundary, checked before deal.II gets to see it, which supposes that meshes
   * are what they seem.
   *
   * The mesh is an error if it is not of quadrilaterals or hexahedra of first
   * order only, lies in no plane (2D), or has a cell with a node twice, without
   * volume, or folded, or more than two cells at a face. Cells that are only
   * numbered the other way round are turned, cells that are there twice
   * (because they are in two groups) are taken once. Faces with a physical id
   * that lie inside are no boundary: nothing is said of them, unless the scene
   * wants to prescribe something there.
   */
  template <int dim>
  class MeshFile
  {
  public:
    /** Reads and checks. Throws InputError, with @p where as its beginning. */
    MeshFile(const std::string &path, const std::string &where);

    /** The physical id of the faces with a name; throws InputError if there is
     * none. */
    dealii::types::boundary_id boundary_id(const std::string &name,
                                           const std::string &where) const;

    /** The same of cells. */
    dealii::types::material_id material_id(const std::string &name,
                                           const std::string &where) const;

    /**
     * Makes the mesh.
     * @param used_ids  the boundary ids that the scene speaks of. A face in two
     *   groups has the one of them that is used; that both are is an error, and
     *   so is a group that is used and lies on the boundary in part only.
     * @param used_materials  the physical ids of cells that the scene speaks
     *   of; the same holds for a cell in two groups.
     */
    void make(const std::set<dealii::types::boundary_id> &used_ids,
              const std::set<dealii::types::material_id> &used_materials,
              dealii::Triangulation<dim>                 &triangulation) const;

    /** The largest distance of two vertices, or a little more: the diagonal of
     * the box around them. */
    double size() const;

    /** Whether a group has faces, none of which lies on the boundary. */
    bool lies_inside(const dealii::types::boundary_id id) const;

  private:
    static constexpr unsigned int n_cell_vertices = 1 << dim;
    static constexpr unsigned int n_face_vertices = 1 << (dim - 1);

    // The numbers of its vertices, sorted.
    using Face = std::array<unsigned int, n_face_vertices>;

    struct Cell
    {
      std::size_t number; ///< in the file
      int         physical_id;

      /// In the order of deal.II.
      std::array<unsigned int, n_cell_vertices> vertices;
    };

    /// Faces of a group that lie inside the body: how many, one of them, and
    /// whether the group has no others.
    struct InnerFaces
    {
      std::size_t n = 0;
      std::string place;
      bool        is_whole = false;
    };

    [[noreturn]] void fail(const std::string &what) const;

    void check_kinds(const GmshFile &file) const;
    void take_cells(const GmshFile &file);
    void take_vertices(const GmshFile &file);
    void check_cell(Cell &cell) const;
    void find_boundary();
    void take_groups(const GmshFile &file);

    int physical_id(
      const Cell                                 &cell,
      const std::set<dealii::types::material_id> &used_materials) const;

    int id_of_name(const std::map<std::string, int> &ids,
                   const std::string                &kind,
                   const std::string                &name,
                   const std::string                &where) const;

    std::string place(const Cell &cell) const;
    std::string place(const Face &face) const;

    std::string                                              beginning;
    std::vector<dealii::Point<dim>>                          vertices;
    std::vector<Cell>                                        cells;
    std::vector<Face>                                        boundary;
    std::vector<std::pair<Face, dealii::types::boundary_id>> groups;
    std::map<dealii::types::boundary_id, InnerFaces>         inner_faces;
    std::map<std::string, int> ids_of_names, ids_of_cell_names;

    // Of cells that are in several groups: the others, by number of the cell.
    std::map<std::size_t, std::vector<int>> further_ids;
  };
} // namespace Friction

#endif
