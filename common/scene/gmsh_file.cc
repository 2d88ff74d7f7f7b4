#include <common/input_error.h>
#include <common/printable.h>
#include <common/scene/gmsh_file.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <unordered_map>

namespace Friction
{
  namespace
  {
    struct ElementType
    {
      unsigned int dimension;
      unsigned int n_nodes;
      std::string  name;
    };



    // Gmsh's numbers of types, up to third order.
    const std::map<int, ElementType> &
    element_types()
    {
      static const std::map<int, ElementType> types = {
        {1, {1, 2, "lines"}},
        {2, {2, 3, "triangles"}},
        {3, {2, 4, "quadrilaterals"}},
        {4, {3, 4, "tetrahedra"}},
        {5, {3, 8, "hexahedra"}},
        {6, {3, 6, "prisms"}},
        {7, {3, 5, "pyramids"}},
        {8, {1, 3, "lines of second order"}},
        {9, {2, 6, "triangles of second order"}},
        {10, {2, 9, "quadrilaterals of second order"}},
        {11, {3, 10, "tetrahedra of second order"}},
        {12, {3, 27, "hexahedra of second order"}},
        {13, {3, 18, "prisms of second order"}},
        {14, {3, 14, "pyramids of second order"}},
        {15, {0, 1, "points"}},
        {16, {2, 8, "quadrilaterals of second order"}},
        {17, {3, 20, "hexahedra of second order"}},
        {18, {3, 15, "prisms of second order"}},
        {19, {3, 13, "pyramids of second order"}},
        {20, {2, 9, "triangles of third order"}},
        {21, {2, 10, "triangles of third order"}},
        {26, {1, 4, "lines of third order"}},
        {29, {3, 20, "tetrahedra of third order"}},
        {36, {2, 16, "quadrilaterals of third order"}},
        {92, {3, 64, "hexahedra of third order"}}};
      return types;
    }



    /** A position in the bytes of the file, which has read what is before it.
     */
    class Reader
    {
    public:
      Reader(const std::string &bytes, const std::string &beginning)
        : bytes(bytes)
        , beginning(beginning)
      {}

      [[noreturn]] void
      fail(const std::string &what) const
      {
        throw InputError(beginning + what);
      }

      bool
      at_end() const
      {
        return position >= bytes.size();
      }

      std::string
      line()
      {
        const std::size_t end =
          std::min(bytes.find('\n', position), bytes.size());
        std::string text = bytes.substr(position, end - position);
        position         = std::min(end + 1, bytes.size());
        while (!text.empty() &&
               std::isspace(static_cast<unsigned char>(text.back())))
          text.pop_back();
        return text;
      }

      void
      begin_section(const std::string &name)
      {
        section = name;
      }

      void
      skip_section()
      {
        const std::size_t end = bytes.find(end_of(section), position);
        if (end == bytes.npos)
          end_of_file();
        position = end;
        line();
      }

      void
      end_section()
      {
        std::string text;
        while (text.empty() && !at_end())
          text = line();
        if (text != end_of(section))
          fail("has more in its section " + section +
               " than it says there is; it may be damaged.");
      }

      double
      real()
      {
        if (is_binary)
          return raw<double>();
        char *const  begin = word();
        char        *end   = begin;
        const double value = std::strtod(begin, &end);
        advance(begin, end);
        if (!std::isfinite(value))
          fail("has a coordinate that is no number in its section " + section +
               ".");
        return value;
      }

      // As format 2.2 and tags of entities have them, 4 bytes long.
      long
      integer()
      {
        if (is_binary)
          return raw<std::int32_t>();
        char *const begin = word();
        char       *end   = begin;
        errno             = 0;
        const long value  = std::strtol(begin, &end, 10);
        advance(begin, end);
        return value;
      }

      // As numbers and tags of nodes and elements in format 4.1, 8 bytes long.
      std::size_t
      size()
      {
        const long value = is_binary ? raw<std::int64_t>() : integer();
        if (value < 0)
          fail("has a negative number in its section " + section +
               " where it should have none; it may be damaged.");
        return value;
      }

      // How many things of at least so many bytes follow: no more than there is
      // room for, so that a damaged number asks for no memory.
      std::size_t
      checked(const std::size_t n, const std::size_t smallest = 2) const
      {
        if (n > (bytes.size() - position) / smallest)
          fail("says that there is more in its section " + section +
               " than there is in all of it; it may be damaged.");
        return n;
      }

      bool is_binary = false;

    private:
      // Version 1 has names in capitals.
      static std::string
      end_of(const std::string &section)
      {
        return (section == "$NOD" || section == "$ELM" ? "$END" : "$End") +
          section.substr(1);
      }

      [[noreturn]] void
      end_of_file() const
      {
        fail("ends in the middle of its section " + section +
             "; it may be damaged, or not have been written to the end.");
      }

      template <typename T>
      T
      raw()
      {
        if (bytes.size() - position < sizeof(T))
          end_of_file();
        T value;
        std::memcpy(&value, bytes.data() + position, sizeof(T));
        position += sizeof(T);
        return value;
      }

      char *
      word()
      {
        while (position < bytes.size() &&
               std::isspace(static_cast<unsigned char>(bytes[position])))
          ++position;
        if (position >= bytes.size())
          end_of_file();
        return const_cast<char *>(bytes.c_str()) + position;
      }

      void
      advance(const char *begin, const char *end)
      {
        if (begin == end)
          fail("has something else than a number in its section " + section +
               ", after " + std::to_string(position) +
               " bytes; it may be damaged.");
        position += end - begin;
      }

      const std::string &bytes;
      const std::string  beginning;
      std::string        section;
      std::size_t        position = 0;
    };



    /** Collects what is read, whatever the format. */
    class Collector
    {
    public:
      Collector(const Reader &reader, GmshFile &file)
        : reader(reader)
        , file(file)
      {}

      void
      add_node(const std::size_t tag, const dealii::Point<3> &p)
      {
        for (unsigned int d = 0; d < 3; ++d)
          if (!std::isfinite(p[d]))
            reader.fail("has a node whose coordinates are no numbers.");
        if (!index_of_tag.emplace(tag, file.nodes.size()).second)
          reader.fail("has two nodes with the number " + std::to_string(tag) +
                      ".");
        file.nodes.push_back(p);
      }

      const ElementType &
      type(const long number) const
      {
        const auto found = element_types().find(number);
        if (found == element_types().end())
          reader.fail("has elements of Gmsh's type " + std::to_string(number) +
                      ", which is not known here; make a mesh of "
                      "quadrilaterals or hexahedra of first order.");
        return found->second;
      }

      // Negative ones say that the orientation of a curve is another one.
      int
      physical_id(const long number) const
      {
        if (std::abs(number) > 2000000000)
          reader.fail("has a physical id " + std::to_string(number) +
                      ", which is too large.");
        return std::abs(number);
      }

      // Node tags in the order of Gmsh.
      void
      add_element(const long                      type_number,
                  const std::size_t               number,
                  const std::vector<int>         &physical_ids,
                  const std::vector<std::size_t> &tags)
      {
        if (type_number != GmshFile::line &&
            type_number != GmshFile::quadrilateral &&
            type_number != GmshFile::hexahedron)
          {
            const ElementType &t = type(type_number);
            if (t.dimension > 0)
              ++file.others[{t.dimension, t.name}];
            return;
          }
        GmshFile::Element element;
        element.number = number;
        element.nodes.fill(0);
        for (unsigned int i = 0; i < tags.size(); ++i)
          {
            const auto node = index_of_tag.find(tags[i]);
            if (node == index_of_tag.end())
              reader.fail("has an element, number " + std::to_string(number) +
                          ", of a node that there is not, number " +
                          std::to_string(tags[i]) + ".");
            element.nodes[i] = node->second;
          }
        auto &list = file.elements[static_cast<GmshFile::Kind>(type_number)];
        for (const int id : physical_ids)
          {
            element.physical_id = id;
            list.push_back(element);
          }
      }

    private:
      const Reader                                 &reader;
      GmshFile                                     &file;
      std::unordered_map<std::size_t, unsigned int> index_of_tag;
    };



    // Always as text: 'dimension id "name"'.
    void
    read_names(Reader &reader, GmshFile &file)
    {
      const long n = std::atol(reader.line().c_str());
      for (long i = 0; i < n && !reader.at_end(); ++i)
        {
          const std::string text  = reader.line();
          const auto        first = text.find('"'), last = text.rfind('"');
          int               dimension = -1, id = 0;
          if (std::sscanf(text.c_str(), "%d %d", &dimension, &id) != 2 ||
              first == last || dimension < 0 || dimension > 3)
            reader.fail("has a section $PhysicalNames that cannot be "
                        "understood.");
          id                     = std::abs(std::max(id, -2000000000));
          const std::string name = text.substr(first + 1, last - first - 1);
          const auto        entry =
            file.names.emplace(std::make_pair(dimension, name), id);
          if (!entry.second && entry.first->second != id)
            reader.fail("calls two physical groups '" + excerpt(name) + "', " +
                        std::to_string(entry.first->second) + " and " +
                        std::to_string(id) + "; give each a name of its own.");
        }
    }



    void
    read_format_2(Reader            &reader,
                  const std::string &section,
                  Collector         &collect)
    {
      const std::size_t n = std::strtoul(reader.line().c_str(), nullptr, 10);
      reader.checked(n);
      if (section == "$Nodes")
        for (std::size_t i = 0; i < n; ++i)
          {
            const long       tag = reader.integer();
            dealii::Point<3> p;
            for (unsigned int d = 0; d < 3; ++d)
              p[d] = reader.real();
            collect.add_node(tag, p);
          }
      else
        {
          // Binary files say once for several elements what they are.
          std::size_t              n_read = 0;
          std::vector<std::size_t> nodes;
          while (n_read < n)
            {
              long number = 0, type = 0, n_alike = 1, n_tags = 0;
              if (reader.is_binary)
                {
                  type    = reader.integer();
                  n_alike = reader.integer();
                  n_tags  = reader.integer();
                }
              else
                {
                  number = reader.integer();
                  type   = reader.integer();
                  n_tags = reader.integer();
                }
              if (n_alike < 1 || n_tags < 0)
                reader.fail("has a section $Elements that cannot be "
                            "understood; it may be damaged.");
              reader.checked(n_tags);
              for (long i = 0; i < n_alike; ++i)
                {
                  if (reader.is_binary)
                    number = reader.integer();
                  int physical_id = 0;
                  for (long t = 0; t < n_tags; ++t)
                    {
                      const long tag = reader.integer();
                      if (t == 0)
                        physical_id = collect.physical_id(tag);
                    }
                  nodes.resize(collect.type(type).n_nodes);
                  for (std::size_t &node : nodes)
                    node = reader.integer();
                  collect.add_element(type, number, {physical_id}, nodes);
                }
              n_read += n_alike;
            }
        }
    }



    // Version 1 is that of deal.II's GridOut: always text, and an element says
    // how many nodes it has.
    void
    read_format_1(Reader            &reader,
                  const std::string &section,
                  Collector         &collect)
    {
      for (long n = reader.integer(); n > 0; --n)
        {
          const long number = reader.integer();
          if (section == "$NOD")
            {
              dealii::Point<3> p;
              for (unsigned int d = 0; d < 3; ++d)
                p[d] = reader.real();
              collect.add_node(number, p);
              continue;
            }
          const long type = reader.integer();
          const int  id   = collect.physical_id(reader.integer());
          reader.integer();
          std::vector<std::size_t> nodes(collect.type(type).n_nodes);
          if (reader.integer() != static_cast<long>(nodes.size()))
            reader.fail("has an element, number " + std::to_string(number) +
                        ", with another number of nodes than its type has.");
          for (std::size_t &node : nodes)
            node = reader.integer();
          collect.add_element(type, number, {id}, nodes);
        }
    }



    // The physical ids of each entity, by its dimension and tag.
    using Entities = std::map<std::pair<long, long>, std::vector<int>>;

    void
    read_entities(Reader &reader, const Collector &collect, Entities &entities)
    {
      std::array<std::size_t, 4> n;
      for (std::size_t &count : n)
        count = reader.size();
      for (unsigned int dimension = 0; dimension < 4; ++dimension)
        for (std::size_t i = reader.checked(n[dimension]); i > 0; --i)
          {
            const long tag = reader.integer();
            for (unsigned int c = 0; c < (dimension == 0 ? 3u : 6u); ++c)
              reader.real();
            std::vector<int> &ids = entities[{dimension, tag}];
            ids.resize(reader.checked(reader.size()));
            for (int &id : ids)
              id = collect.physical_id(reader.integer());
            if (dimension == 0)
              continue;
            for (std::size_t b = reader.checked(reader.size()); b > 0; --b)
              reader.integer();
          }
    }



    void
    read_format_4(Reader            &reader,
                  const std::string &section,
                  const Entities    &entities,
                  Collector         &collect)
    {
      const std::size_t n_blocks = reader.checked(reader.size());
      for (unsigned int i = 0; i < 3; ++i)
        reader.size();
      for (std::size_t block = 0; block < n_blocks; ++block)
        {
          const long        dimension = reader.integer();
          const long        tag       = reader.integer();
          const long        third     = reader.integer();
          const std::size_t n         = reader.checked(reader.size());
          if (dimension < 0 || dimension > 3)
            reader.fail("has a section " + section +
                        " that cannot be understood; it may be damaged.");
          if (section == "$Nodes")
            {
              std::vector<std::size_t> tags(n);
              for (std::size_t &t : tags)
                t = reader.size();
              for (const std::size_t t : tags)
                {
                  dealii::Point<3> p;
                  for (unsigned int d = 0; d < 3; ++d)
                    p[d] = reader.real();
                  // The parameters of its curve or surface.
                  for (long d = 0; third != 0 && d < dimension; ++d)
                    reader.real();
                  collect.add_node(t, p);
                }
            }
          else
            {
              const auto              entity = entities.find({dimension, tag});
              const std::vector<int>  none   = {0};
              const std::vector<int> &ids =
                (entity == entities.end() || entity->second.empty())
                ? none
                : entity->second;
              std::vector<std::size_t> nodes(collect.type(third).n_nodes);
              for (std::size_t i = 0; i < n; ++i)
                {
                  const std::size_t number = reader.size();
                  for (std::size_t &node : nodes)
                    node = reader.size();
                  collect.add_element(third, number, ids, nodes);
                }
            }
        }
    }
  } // namespace



  GmshFile
  read_gmsh_file(const std::string &path, const std::string &where)
  {
    const std::string beginning =
      where + "the mesh file '" + excerpt(path, 300) + "' ";
    std::error_code no_error;
    if (std::filesystem::is_directory(path, no_error) ||
        std::filesystem::is_character_file(path, no_error))
      throw InputError(beginning + "is no file but a " +
                       (std::filesystem::is_directory(path, no_error)
                          ? "directory"
                          : "device") +
                       "; correct 'Scene/Mesh file'.");
    std::ifstream     stream(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream.is_open() || bytes.empty())
      throw InputError(
        where + (stream.is_open() ? "there is nothing in" : "cannot open") +
        " the mesh file '" + excerpt(path, 300) +
        "'; correct 'Scene/Mesh file'.");

    GmshFile  file;
    Reader    reader(bytes, beginning);
    Collector collect(reader, file);
    Entities  entities;
    double    format    = 0;
    bool      has_nodes = false, has_elements = false;
    while (!reader.at_end())
      {
        std::string section = reader.line();
        // Some editors begin a file with three bytes that mean UTF-8.
        if (section.rfind("\xef\xbb\xbf", 0) == 0)
          section.erase(0, 3);
        if (section.empty())
          continue;
        const bool is_version_1 = section == "$NOD" || section == "$ELM";
        if (section[0] != '$' ||
            (format == 0 && !is_version_1 && section != "$MeshFormat" &&
             section != "$Comments"))
          {
            if (format == 0 && !has_nodes)
              reader.fail(
                "is not in Gmsh's format .msh; export it from Gmsh as "
                "version 2.2 or 4.1.");
            reader.fail(
              "has something between its sections that does not belong "
              "there; it may be damaged.");
          }
        reader.begin_section(section);
        if (section == "$MeshFormat")
          {
            int is_binary = 0, bytes_per_real = 0;
            if (std::sscanf(reader.line().c_str(),
                            "%lf %d %d",
                            &format,
                            &is_binary,
                            &bytes_per_real) != 3 ||
                bytes_per_real != 8)
              reader.fail("has a section $MeshFormat that cannot be "
                          "understood.");
            if (format != 2.2 && format != 4.1)
              reader.fail("is in version " +
                          std::to_string(format).substr(0, 3) +
                          " of Gmsh's format; save it as version 2.2 or 4.1.");
            reader.is_binary = is_binary != 0;
            if (reader.is_binary && reader.integer() != 1)
              reader.fail("comes from a machine that stores numbers the other "
                          "way round; save it as text.");
          }
        else if (is_version_1)
          {
            (section == "$NOD" ? has_nodes : has_elements) = true;
            read_format_1(reader, section, collect);
          }
        else if (section == "$PartitionedEntities")
          reader.fail("is partitioned; save it without partitions, since the "
                      "programs distribute meshes themselves.");
        else if (section == "$PhysicalNames")
          read_names(reader, file);
        else if (section == "$Entities" && format == 4.1)
          read_entities(reader, collect, entities);
        else if (section == "$Nodes" || section == "$Elements")
          {
            (section == "$Nodes" ? has_nodes : has_elements) = true;
            if (format == 4.1)
              read_format_4(reader, section, entities, collect);
            else
              read_format_2(reader, section, collect);
          }
        else
          {
            reader.skip_section();
            continue;
          }
        reader.end_section();
      }
    if (!has_nodes || !has_elements)
      reader.fail(std::string("has no section ") +
                  (has_nodes ? "$Elements" : "$Nodes") +
                  "; it may not have been written to the end.");
    return file;
  }
} // namespace Friction
