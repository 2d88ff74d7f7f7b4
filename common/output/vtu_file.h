#ifndef friction_output_vtu_file_h
#define friction_output_vtu_file_h

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * One process's part of a mesh, with fields, as it is written into a `.vtu`
   * file.
   */
  struct VtuPiece
  {
    /// VTK's numbers of the kinds of cells. The corners of a quadrilateral and
    /// of each layer of a hexahedron follow each other around it, unlike
    /// deal.II's.
    enum class Cell : std::uint8_t
    {
      line          = 3,
      quadrilateral = 9,
      hexahedron    = 12
    };

    /**
     * Numbers of points or of cells: one, the three of a vector, or the six of
     * a symmetric tensor, in VTK's order XX, YY, ZZ, XY, YZ, XZ.
     */
    struct Field
    {
      std::string        name;
      unsigned int       n_components;
      std::vector<float> values;
    };

    explicit VtuPiece(const Cell cell);

    unsigned int n_vertices_per_cell() const;

    std::size_t n_points() const;

    std::size_t n_cells() const;

    Cell cell;

    /// Three coordinates of each point. They have double precision: the contact
    /// zone, and with it the cells there, may be a millionth of the body.
    std::vector<double> points;

    /// The points of each cell.
    std::vector<std::int32_t> corners;

    std::vector<Field> point_fields;
    std::vector<Field> cell_fields;
  };



  /**
   * Write a piece as VTK's XML file of an unstructured grid. Whatever there is
   * much of stands behind the XML as it is in memory, neither coded nor
   * compressed (`appended` and `raw` in the terms of VTK): to compress floating
   * point numbers takes longer than to write all of them.
   *
   * @param level is written as the time.
   */
  void
  write_vtu(std::ostream &out, const VtuPiece &piece, const unsigned int level);

  /**
   * Write the record of all processes' pieces.
   *
   * @param piece  of one of them; all have the same fields.
   * @param names  of their files, relative to that of the record.
   */
  void write_pvtu(std::ostream                   &out,
                  const VtuPiece                 &piece,
                  const std::vector<std::string> &names);
} // namespace Friction

#endif
