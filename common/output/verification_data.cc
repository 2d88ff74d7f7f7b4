#include <common/compatibility.h>
#include <common/output/verification_data.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/hdf5.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace Friction
{
  namespace
  {
    // Datasets by name, rows one after the other: those of a process, and in
    // the end those of all.
    template <typename Number>
    struct DataColumns
    {
      unsigned int        width = 1;
      std::vector<Number> values;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &width &values;
      }
    };

    template <typename Number>
    using DataTables = std::map<std::string, DataColumns<Number>>;

    template <typename Number>
    void
    append_tables(DataTables<Number> &to, const DataTables<Number> &from)
    {
      for (const auto &entry : from)
        {
          DataColumns<Number> &columns = to[entry.first];
          columns.width                = entry.second.width;
          columns.values.insert(columns.values.end(),
                                entry.second.values.begin(),
                                entry.second.values.end());
        }
    }

    template <typename Number>
    void
    write_tables(const dealii::HDF5::File &file,
                 const DataTables<Number> &tables)
    {
      for (const auto &entry : tables)
        if (!entry.second.values.empty())
          {
            const hsize_t        width = entry.second.width;
            std::vector<hsize_t> size  = {entry.second.values.size() / width};
            if (width > 1)
              size.push_back(width);
            file.create_dataset<Number>(entry.first, size)
              .write(entry.second.values);
          }
    }



    // One problem: what has numbers for entries, and what has numbers of nodes.
    struct ProblemTables
    {
      DataTables<double>       values;
      DataTables<unsigned int> numbers;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &values &numbers;
      }

      // A row more, of numbers, of one value, or of components.
      void
      add_numbers(const std::string &name, const std::vector<unsigned int> &row)
      {
        add_to(numbers, name, row);
      }

      void
      add_value(const std::string &name, const double value)
      {
        add_to(values, name, std::array<double, 1>{{value}});
      }

      template <int dim>
      void
      add_vector(const std::string &name, const Tensor<1, dim> &vector)
      {
        std::array<double, dim> row;
        for (unsigned int d = 0; d < dim; ++d)
          row[d] = vector[d];
        add_to(values, name, row);
      }

      void
      append(const ProblemTables &other)
      {
        append_tables(values, other.values);
        append_tables(numbers, other.numbers);
      }

      // In bytes.
      std::uint64_t
      size() const
      {
        std::uint64_t sum = 0;
        for (const auto &entry : values)
          sum += sizeof(double) * entry.second.values.size();
        for (const auto &entry : numbers)
          sum += sizeof(unsigned int) * entry.second.values.size();
        return sum;
      }

    private:
      template <typename Number, typename Row>
      static void
      add_to(DataTables<Number> &tables,
             const std::string  &name,
             const Row          &row)
      {
        DataColumns<Number> &columns = tables[name];
        columns.width                = row.size();
        columns.values.insert(columns.values.end(), row.begin(), row.end());
      }
    };



    // The value of a load at each point of a cell or a face, which is the image
    // of the unit square or cube under (multi)linear functions. What FEValues
    // says of it is not asked for.
    template <int dim, int object_dim>
    void
    add_load_values(ProblemTables                 &tables,
                    const std::string             &name,
                    const Function<dim>           &load,
                    const std::vector<Point<dim>> &corners,
                    const Quadrature<object_dim>  &quadrature)
    {
      Vector<double> value(dim);
      for (const Point<object_dim> &on_unit_cell : quadrature.get_points())
        {
          Point<dim> point;
          for (unsigned int v = 0; v < corners.size(); ++v)
            point += GeometryInfo<object_dim>::d_linear_shape_function(
                       on_unit_cell, v) *
              corners[v];
          load.vector_value(point, value);
          Tensor<1, dim> row;
          for (unsigned int d = 0; d < dim; ++d)
            row[d] = value[d];
          tables.add_vector(name, row);
        }
    }



    // The cells of this process, what is at their boundary, and the loads
    // there.
    template <int dim>
    void
    add_cells(ProblemTables &tables, const Discretization<dim> &discretization)
    {
      const Scene<dim>     &scene     = discretization.scene();
      const Materials<dim> &materials = scene.materials();
      const QGauss<dim>     cell_points(2);
      const QGauss<dim - 1> face_points(4);
      for (const auto &cell :
           discretization.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            std::vector<unsigned int> nodes;
            std::vector<Point<dim>>   corners;
            for (const unsigned int v : cell->vertex_indices())
              {
                nodes.push_back(cell->vertex_dof_index(v, 0) / dim);
                corners.push_back(cell->vertex(v));
              }
            tables.add_numbers("cells", nodes);
            if (!materials.is_homogeneous())
              {
                tables.add_numbers("cell_ids", {cell->material_id()});
                tables.add_numbers("cell_regions", {materials.region(cell)});
              }
            if (scene.body_force() != nullptr)
              add_load_values(tables,
                              "body_force",
                              *scene.body_force(),
                              corners,
                              cell_points);

            for (const unsigned int f : cell->face_indices())
              if (cell->at_boundary(f))
                {
                  std::vector<unsigned int> face_nodes;
                  std::vector<Point<dim>>   face_corners;
                  for (unsigned int v = 0;
                       v < GeometryInfo<dim>::vertices_per_face;
                       ++v)
                    {
                      const unsigned int in_cell =
                        GeometryInfo<dim>::face_to_cell_vertices(f, v);
                      face_nodes.push_back(nodes[in_cell]);
                      face_corners.push_back(corners[in_cell]);
                    }
                  const types::boundary_id id = cell->face(f)->boundary_id();
                  tables.add_numbers("boundary_faces", face_nodes);
                  tables.add_numbers("boundary_ids", {id});
                  for (const auto &condition : scene.traction_conditions())
                    if (condition.boundary_id == id)
                      {
                        tables.add_numbers("traction_faces", face_nodes);
                        add_load_values(tables,
                                        "tractions",
                                        *condition.traction,
                                        face_corners,
                                        face_points);
                      }
                }
          }
    }



    // The nodes of this process. Numbers of nodes are those of the whole mesh,
    // and each process has consecutive ones, so that the rows of all of them,
    // one process after the other, are in order.
    template <int dim>
    void
    add_nodes(ProblemTables             &tables,
              const Discretization<dim> &discretization,
              const VectorType          &displacement)
    {
      const NodalConstraints<dim> &constraints = discretization.constraints();
      std::vector<Point<dim>>      points(constraints.n_owned_nodes());
      for (const auto &cell :
           discretization.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int v : cell->vertex_indices())
            {
              const unsigned int node =
                constraints.node_of_dof(cell->vertex_dof_index(v, 0));
              if (node < points.size())
                points[node] = cell->vertex(v);
            }

      for (unsigned int node = 0; node < points.size(); ++node)
        {
          const types::global_dof_index dof =
            constraints.partitioner()->local_to_global(dim * node);
          const unsigned int number = dof / dim;
          Tensor<1, dim>     u;
          for (unsigned int d = 0; d < dim; ++d)
            u[d] = displacement.local_element(dim * node + d);
          tables.add_vector<dim>("vertices", points[node]);
          tables.add_vector("displacement", u);

          if (constraints.is_hanging(node))
            for (const auto &master :
                 *discretization.hanging_nodes().get_constraint_entries(dof))
              {
                tables.add_numbers(
                  "hanging_nodes",
                  {number, static_cast<unsigned int>(master.first / dim)});
                tables.add_value("hanging_weights", master.second);
              }
          else
            for (unsigned int d = 0; d < dim; ++d)
              if (constraints.is_prescribed(node, d))
                {
                  tables.add_numbers("prescribed", {number, d});
                  tables.add_value(
                    "prescribed_values",
                    constraints.prescribed_values().local_element(dim * node +
                                                                  d));
                }
        }
    }



    // Loads are expressions, which may have no value somewhere.
    template <int dim>
    void
    add_cells_together(ProblemTables             &tables,
                       const Discretization<dim> &discretization)
    {
      on_all_processes(discretization.constraints().communicator(),
                       [&]() { add_cells(tables, discretization); });
    }



    template <int dim>
    void
    add_contact(ProblemTables                         &tables,
                const Scene<dim>                      &scene,
                const bool                             has_slip_origin,
                const std::vector<ContactRecord<dim>> &own_contact)
    {
      const auto &conditions = scene.contact_conditions();
      const auto  any        = [&](const auto &has) {
        return std::any_of(conditions.begin(), conditions.end(), has);
      };
      const bool any_varies =
        any([](const auto &c) { return c.varying_coefficient != nullptr; });
      const bool any_bound =
        any([](const auto &c) { return c.friction_bound != nullptr; });
      for (const ContactRecord<dim> &record : own_contact)
        {
          const ContactCondition<dim> &condition = *std::find_if(
            conditions.begin(), conditions.end(), [&](const auto &c) {
              return c.number == record.section;
            });
          if (conditions.size() > 1)
            tables.add_numbers("contact_sections", {record.section});

          tables.add_numbers("contact_nodes",
                             {static_cast<unsigned int>(record.dof / dim)});
          tables.add_numbers("contact_states", {record.state});
          tables.add_vector("contact_normals", record.normal);
          if (has_slip_origin)
            tables.add_vector("slip_origins", record.slip_origin);
          if (any_varies)
            tables.add_value(
              "friction_coefficients",
              condition.varying_coefficient == nullptr
                ? condition.friction_coefficient
                : condition.varying_coefficient->value(record.point));
          if (any_bound)
            tables.add_value("friction_bounds",
                             condition.friction_bound == nullptr
                               ? 0.
                               : condition.friction_bound->value(record.point));
        }
    }



    // What is behind the names of what belongs to 'Contact 2'.
    template <int dim>
    std::string
    suffix_of(const ContactCondition<dim> &condition)
    {
      return condition.number == 1 ? ""
                                   : '_' + std::to_string(condition.number);
    }



    // By number of the region, unless there is none.
    template <int dim>
    void
    add_materials(ProblemTables &tables, const Materials<dim> &materials)
    {
      if (!materials.is_homogeneous())
        for (const Material &material : materials.of_regions())
          tables.add_vector<3>(
            "materials",
            Tensor<1, 3>({material.youngs_modulus(),
                          material.poisson_ratio(),
                          material.volumetric_strain() == VolumetricStrain::mean
                            ? 1.
                            : 0.}));
    }



    template <int dim>
    void
    add_obstacle(ProblemTables &tables, const ContactCondition<dim> &condition)
    {
      const std::string suffix = suffix_of(condition);
      for (const auto &plane : condition.obstacle.half_spaces())
        {
          tables.add_vector<dim>("plane_points" + suffix, plane.point);
          tables.add_vector("plane_normals" + suffix, plane.normal);
        }
      for (const auto &rod : condition.obstacle.circular_rods())
        {
          tables.add_vector<dim>("rod_centers" + suffix, rod.center);
          tables.add_vector("rod_axes" + suffix, rod.axis);
          tables.add_value("rod_radii" + suffix, rod.radius);
          tables.add_value("rod_lengths" + suffix,
                           std::isfinite(rod.length) ? rod.length : 0.);
          tables.add_value("rod_sides" + suffix, rod.is_hole ? -1. : 1.);
        }
    }



    template <int dim>
    void
    write_attributes(dealii::HDF5::File &file,
                     const unsigned int  level,
                     const Scene<dim>   &scene)
    {
      const Material &material = scene.materials().base();
      file.set_attribute("dimension", dim);
      file.set_attribute("level", level);
      file.set_attribute("youngs_modulus", material.youngs_modulus());
      file.set_attribute("poisson_ratio", material.poisson_ratio());
      file.set_attribute(
        "volumetric_strain",
        std::string(material.volumetric_strain() == VolumetricStrain::mean
                      ? "mean"
                      : "pointwise"));
      for (const ContactCondition<dim> &contact : scene.contact_conditions())
        {
          const std::string suffix = suffix_of(contact);
          const FrictionLaw law    = contact.friction_law;
          file.set_attribute("contact_boundary" + suffix,
                             contact.has_boundary()
                               ? static_cast<int>(contact.boundary_id)
                               : -1);
          file.set_attribute("contact_normal" + suffix,
                             std::string(contact.normal == ContactNormal::body
                                           ? "body"
                                           : "obstacle"));
          file.set_attribute("friction_law" + suffix,
                             std::string(law == FrictionLaw::none ? "none"
                                           : law == FrictionLaw::tresca
                                           ? "Tresca"
                                           : "Coulomb"));
          file.set_attribute("friction_coefficient" + suffix,
                             contact.friction_coefficient);
        }
      if (scene.n_load_steps() > 1)
        {
          file.set_attribute("load_step", scene.load_step() + 1);
          file.set_attribute("time", scene.time());
        }
    }



    std::string
    verification_file_name(const unsigned int level)
    {
      return (level < 10 ? "verify-0" : "verify-") + std::to_string(level) +
        ".h5";
    }



    // What all processes know, in one file of the first.
    template <int dim>
    void
    gather_and_write(const std::string         &name,
                     const unsigned int         level,
                     const Discretization<dim> &discretization,
                     const ProblemTables       &own)
    {
      const MPI_Comm communicator =
        Compatibility::mpi_communicator(discretization.dof_handler());
      const Scene<dim> &scene = discretization.scene();
      ProblemTables     all;
      for (const ProblemTables &part :
           Utilities::MPI::gather(communicator, own))
        all.append(part);
      add_materials(all, scene.materials());
      for (const ContactCondition<dim> &contact : scene.contact_conditions())
        add_obstacle(all, contact);

      // HDF5 does not say in one sentence that the disk is full, see History.
      demand_space(name,
                   communicator,
                   Utilities::MPI::max(all.size(), communicator) + (1 << 16));
      on_first_process(communicator, [&]() {
        write_then_rename(name, [&](const std::string &temporary) {
          {
            dealii::HDF5::File file(temporary,
                                    dealii::HDF5::File::FileAccessMode::create);
            write_attributes(file, level, scene);
            write_tables(file, all.values);
            write_tables(file, all.numbers);
          }
          if (std::filesystem::file_size(temporary) < all.size())
            throw InputError(
              "The file '" + name +
              "' cannot be written completely: is the disk full?");
        });
      });
    }
  } // namespace



  template <int dim>
  VerificationData<dim>::VerificationData(const RunDirectory &directory)
    : directory(directory)
  {}



  template <int dim>
  void
  VerificationData<dim>::remove(const unsigned int level) const
  {
    std::error_code ignored;
    std::filesystem::remove(directory.file(verification_file_name(level)),
                            ignored);
  }



  template <int dim>
  void
  VerificationData<dim>::write_level(
    const unsigned int                     level,
    const Discretization<dim>             &discretization,
    const VectorType                      &displacement,
    const std::vector<ContactRecord<dim>> &own_contact) const
  {
    ProblemTables own;
    add_cells_together(own, discretization);
    add_nodes(own, discretization, displacement);
    add_contact(own,
                discretization.scene(),
                discretization.slip_origin() != nullptr,
                own_contact);
    gather_and_write(directory.file(verification_file_name(level)),
                     level,
                     discretization,
                     own);
  }



  template class VerificationData<2>;
  template class VerificationData<3>;
} // namespace Friction
