#include <common/output/vtu_file.h>

#include <limits>
#include <stdexcept>

namespace Friction
{
  namespace
  {
    const char *
    byte_order()
    {
      const std::uint16_t one = 1;
      return *reinterpret_cast<const unsigned char *>(&one) == 1
        ? "LittleEndian"
        : "BigEndian";
    }



    // For VTK's XML each kind of number has a name.
    template <typename Number>
    const char *type_name();

    template <>
    const char *
    type_name<float>()
    {
      return "Float32";
    }

    template <>
    const char *
    type_name<double>()
    {
      return "Float64";
    }

    template <>
    const char *
    type_name<std::int32_t>()
    {
      return "Int32";
    }

    template <>
    const char *
    type_name<std::uint8_t>()
    {
      return "UInt8";
    }



    std::string
    attributes(const char        *type,
               const std::string &name,
               const unsigned int n_components)
    {
      std::string text = std::string("type=\"") + type + '"';
      if (!name.empty())
        text += " Name=\"" + name + '"';
      if (n_components != 1)
        text += " NumberOfComponents=\"" + std::to_string(n_components) + '"';
      return text;
    }



    // The arrays behind the XML. Each begins with its length in bytes, and is
    // found by where it begins.
    class AppendedData
    {
    public:
      explicit AppendedData(std::ostream &out)
        : out(out)
      {}

      // The values must stay where they are until they have been written.
      template <typename Number>
      void
      declare(const std::string         &name,
              const std::vector<Number> &values,
              const unsigned int         n_components = 1)
      {
        const std::uint64_t n_bytes = values.size() * sizeof(Number);
        out << "        <DataArray "
            << attributes(type_name<Number>(), name, n_components)
            << " format=\"appended\" offset=\"" << offset << "\"/>\n";
        offset += sizeof(n_bytes) + n_bytes;
        arrays.push_back({values.data(), n_bytes});
      }

      void
      write() const
      {
        for (const Array &array : arrays)
          {
            out.write(reinterpret_cast<const char *>(&array.n_bytes),
                      sizeof(array.n_bytes));
            out.write(static_cast<const char *>(array.begin), array.n_bytes);
          }
      }

    private:
      struct Array
      {
        const void   *begin;
        std::uint64_t n_bytes;
      };

      std::ostream      &out;
      std::uint64_t      offset = 0;
      std::vector<Array> arrays;
    };



    void
    begin_file(std::ostream &out, const char *type)
    {
      out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << type
          << "\" version=\"1.0\" byte_order=\"" << byte_order()
          << "\" header_type=\"UInt64\">\n  <" << type << ">\n";
    }
  } // namespace



  VtuPiece::VtuPiece(const Cell cell)
    : cell(cell)
  {}



  unsigned int
  VtuPiece::n_vertices_per_cell() const
  {
    return cell == Cell::line ? 2 : cell == Cell::quadrilateral ? 4 : 8;
  }



  std::size_t
  VtuPiece::n_points() const
  {
    return points.size() / 3;
  }



  std::size_t
  VtuPiece::n_cells() const
  {
    return corners.size() / n_vertices_per_cell();
  }



  void
  write_vtu(std::ostream &out, const VtuPiece &piece, const unsigned int level)
  {
    const std::size_t max = std::numeric_limits<std::int32_t>::max();
    if (piece.corners.size() > max)
      throw std::length_error("One process has too many cells for a file.");

    // Cells could have different numbers of corners.
    std::vector<std::int32_t> ends(piece.n_cells());
    for (std::size_t i = 0; i < ends.size(); ++i)
      ends[i] =
        static_cast<std::int32_t>((i + 1) * piece.n_vertices_per_cell());
    const std::vector<std::uint8_t> types(
      ends.size(), static_cast<std::uint8_t>(piece.cell));

    begin_file(out, "UnstructuredGrid");
    out << "    <FieldData>\n"
           "      <DataArray type=\"Float32\" Name=\"TIME\""
           " NumberOfTuples=\"1\" format=\"ascii\">"
        << level
        << "</DataArray>\n"
           "    </FieldData>\n"
           "    <Piece NumberOfPoints=\""
        << piece.n_points() << "\" NumberOfCells=\"" << piece.n_cells()
        << "\">\n";
    AppendedData data(out);
    out << "      <Points>\n";
    data.declare("", piece.points, 3);
    out << "      </Points>\n      <Cells>\n";
    data.declare("connectivity", piece.corners);
    data.declare("offsets", ends);
    data.declare("types", types);
    out << "      </Cells>\n      <PointData>\n";
    for (const VtuPiece::Field &field : piece.point_fields)
      data.declare(field.name, field.values, field.n_components);
    out << "      </PointData>\n      <CellData>\n";
    for (const VtuPiece::Field &field : piece.cell_fields)
      data.declare(field.name, field.values, field.n_components);
    out << "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n"
           "  <AppendedData encoding=\"raw\">\n_";
    data.write();
    out << "\n  </AppendedData>\n</VTKFile>\n";
  }



  void
  write_pvtu(std::ostream                   &out,
             const VtuPiece                 &piece,
             const std::vector<std::string> &names)
  {
    const auto declare = [&](const std::vector<VtuPiece::Field> &fields) {
      for (const VtuPiece::Field &field : fields)
        out << "      <PDataArray "
            << attributes("Float32", field.name, field.n_components) << "/>\n";
    };

    begin_file(out, "PUnstructuredGrid");
    out << "    <PPoints>\n      <PDataArray " << attributes("Float64", "", 3)
        << "/>\n    </PPoints>\n    <PPointData>\n";
    declare(piece.point_fields);
    out << "    </PPointData>\n    <PCellData>\n";
    declare(piece.cell_fields);
    out << "    </PCellData>\n";
    for (const std::string &name : names)
      out << "    <Piece Source=\"" << name << "\"/>\n";
    out << "  </PUnstructuredGrid>\n</VTKFile>\n";
  }
} // namespace Friction
