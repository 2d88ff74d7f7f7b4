#include <common/compatibility.h>
#include <common/discretization/volumetric_strain.h>
#include <common/output/fields.h>
#include <common/output/left_overs.h>
#include <common/parallel/collective_error.h>

#include <deal.II/numerics/data_postprocessor.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <tuple>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    using NonscalarRanges = std::vector<
      std::tuple<unsigned int,
                 unsigned int,
                 std::string,
                 DataComponentInterpretation::DataComponentInterpretation>>;



    DataOutBase::VtkFlags
    vtk_flags(const unsigned int level)
    {
      DataOutBase::VtkFlags flags;
      flags.time  = level;
      flags.cycle = level;
      // The same run shall give the same file.
      flags.print_date_and_time = false;
      using CompressionLevel    = decltype(flags.compression_level);
      flags.compression_level   = CompressionLevel::best_speed;
      return flags;
    }



    std::string
    file_name(const std::string &what, const unsigned int level)
    {
      return what + (level < 10 ? "-0" : "-") + std::to_string(level);
    }



    std::string
    piece_name(const std::string &what,
               const unsigned int level,
               const unsigned int rank)
    {
      return file_name(what, level) + "." + Utilities::int_to_string(rank, 4) +
        ".vtu";
    }



    std::vector<std::string>
    piece_names(const std::string &what,
                const unsigned int level,
                const unsigned int n_processes)
    {
      std::vector<std::string> names;
      for (unsigned int rank = 0; rank < n_processes; ++rank)
        names.push_back(piece_name(what, level, rank));
      return names;
    }



    // Stresses follow from the gradients of the displacement, so deal.II can
    // evaluate them for us where it needs them.
    template <int dim>
    class Stresses : public DataPostprocessor<dim>
    {
    public:
      Stresses(const Material                   &material,
               const VolumetricStrainField<dim> &volumetric_strain)
        : lambda(material.lambda())
        , mu(material.mu())
        , volumetric_strain(volumetric_strain)
      {}

      void
      evaluate_vector_field(
        const DataPostprocessorInputs::Vector<dim> &inputs,
        std::vector<Vector<double>> &computed_quantities) const override
      {
        const auto cell = inputs.template get_cell<dim>();
        for (unsigned int q = 0; q < computed_quantities.size(); ++q)
          {
            // Always a 3x3 tensor: in plane strain the third normal strain
            // is zero, but the third normal stress is not.
            SymmetricTensor<2, 3> strain;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = i; j < dim; ++j)
                strain[i][j] = 0.5 *
                  (inputs.solution_gradients[q][i][j] +
                   inputs.solution_gradients[q][j][i]);
            const SymmetricTensor<2, 3> stress = 2. * mu * strain +
              lambda * volumetric_strain.value(cell, trace(strain)) *
                unit_symmetric_tensor<3>();

            Vector<double> &values = computed_quantities[q];
            values[0]              = stress[0][0];
            values[1]              = stress[1][1];
            values[2]              = stress[2][2];
            values[3]              = stress[0][1];
            if (dim == 3)
              {
                values[4] = stress[1][2];
                values[5] = stress[0][2];
              }
            values[values.size() - 1] =
              std::sqrt(1.5) * deviator(stress).norm();
          }
      }

      std::vector<std::string>
      get_names() const override
      {
        std::vector<std::string> names = {
          "stress_xx", "stress_yy", "stress_zz", "stress_xy"};
        if (dim == 3)
          {
            names.emplace_back("stress_yz");
            names.emplace_back("stress_xz");
          }
        names.emplace_back("von_Mises_stress");
        return names;
      }

      std::vector<DataComponentInterpretation::DataComponentInterpretation>
      get_data_component_interpretation() const override
      {
        return std::vector<
          DataComponentInterpretation::DataComponentInterpretation>(
          get_names().size(), DataComponentInterpretation::component_is_scalar);
      }

      UpdateFlags
      get_needed_update_flags() const override
      {
        return update_gradients;
      }

    private:
      const double                      lambda;
      const double                      mu;
      const VolumetricStrainField<dim> &volumetric_strain;
    };



    // What is shown in a point of the contact boundary: four vectors, then
    // four numbers.
    constexpr unsigned int n_contact_vectors = 4;
    constexpr unsigned int n_contact_scalars = 4;

    const std::array<std::string, n_contact_vectors> contact_vector_names = {
      {"displacement", "traction", "tangential_traction", "normal"}};
    const std::array<std::string, n_contact_scalars> contact_scalar_names = {
      {"pressure", "gap", "distance", "state"}};



    template <int dim>
    std::vector<std::string>
    contact_data_names()
    {
      std::vector<std::string> names;
      for (const std::string &name : contact_vector_names)
        for (unsigned int c = 0; c < dim; ++c)
          names.push_back(name);
      names.insert(
        names.end(), contact_scalar_names.begin(), contact_scalar_names.end());
      return names;
    }



    template <int dim>
    NonscalarRanges
    contact_data_ranges()
    {
      NonscalarRanges ranges;
      for (unsigned int v = 0; v < n_contact_vectors; ++v)
        ranges.emplace_back(
          v * dim,
          (v + 1) * dim - 1,
          contact_vector_names[v],
          DataComponentInterpretation::component_is_part_of_vector);
      return ranges;
    }



    template <int dim>
    using ContactData =
      std::array<double, n_contact_vectors * dim + n_contact_scalars>;

    template <int dim>
    ContactData<dim>
    contact_data(const ContactRecord<dim> &record)
    {
      Tensor<1, dim> traction;
      if (record.measure > 0.)
        traction = record.force / record.measure;
      const double pressure = -(traction * record.normal);

      ContactData<dim> data;
      for (unsigned int c = 0; c < dim; ++c)
        {
          data[c]           = record.displacement[c];
          data[dim + c]     = traction[c];
          data[2 * dim + c] = traction[c] + pressure * record.normal[c];
          data[3 * dim + c] = record.normal[c];
        }
      data[4 * dim]     = pressure;
      data[4 * dim + 1] = record.gap;
      data[4 * dim + 2] = record.gap - record.displacement * record.normal;
      data[4 * dim + 3] = record.state;
      return data;
    }
  } // namespace



  template <int dim>
  FieldWriter<dim>::FieldWriter(const RunDirectory      &directory,
                                const Material          &material,
                                const types::boundary_id contact_boundary,
                                const FieldFormat        format)
    : directory(directory)
    , material(material)
    , contact_boundary(contact_boundary)
    , format(format)
  {}



  template <int dim>
  void
  FieldWriter<dim>::write_level(const unsigned int                     level,
                                const LevelFields<dim>                &fields,
                                const std::vector<ContactRecord<dim>> &contact)
  {
    write_body(level, fields);

    // Whether there is a contact boundary is a question to all processes.
    if (Utilities::MPI::max<unsigned int>(
          contact.empty() ? 0 : 1,
          Compatibility::mpi_communicator(fields.dof_handler)) > 0)
      write_contact_boundary(level, fields, contact);
  }



  template <int dim>
  void
  FieldWriter<dim>::write_body(const unsigned int      level,
                               const LevelFields<dim> &fields)
  {
    const Mapping<dim>              &mapping      = fields.mapping;
    const DoFHandler<dim>           &dof_handler  = fields.dof_handler;
    const VectorType                &displacement = fields.displacement;
    const Vector<float>             *cell_errors  = fields.cell_errors;
    const VolumetricStrainField<dim> volumetric_strain(
      mapping, dof_handler, material.volumetric_strain(), displacement);
    const Stresses<dim> stresses(material, volumetric_strain);

    DataOut<dim> data_out;
    data_out.attach_dof_handler(dof_handler);
    data_out.add_data_vector(
      displacement,
      std::vector<std::string>(dim, "displacement"),
      DataOut<dim>::type_dof_data,
      std::vector<DataComponentInterpretation::DataComponentInterpretation>(
        dim, DataComponentInterpretation::component_is_part_of_vector));
    data_out.add_data_vector(displacement, stresses);
    if (cell_errors != nullptr)
      data_out.add_data_vector(
        *cell_errors, "estimated_error", DataOut<dim>::type_cell_data);
    data_out.set_flags(vtk_flags(level));
    data_out.build_patches(mapping);

    const MPI_Comm communicator = Compatibility::mpi_communicator(dof_handler);
    bool           has_cells    = false;
    for (const auto &cell : dof_handler.active_cell_iterators())
      has_cells = has_cells || cell->is_locally_owned();
    if (format == FieldFormat::hdf5)
      write_body_hdf5(level, data_out, has_cells, communicator);
    else
      write_body_vtu(level, data_out, communicator);
  }



  template <int dim>
  void
  FieldWriter<dim>::write_body_vtu(const unsigned int  level,
                                   const DataOut<dim> &data_out,
                                   const MPI_Comm      communicator)
  {
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    remove_old_pieces("body", level, body_files, communicator);
    on_all_processes(communicator, [&]() {
      directory.write(piece_name("body", level, rank),
                      [&](std::ostream &out) { data_out.write_vtu(out); });
    });

    // The record names the pieces, which are all there now.
    on_first_process(communicator, [&]() {
      directory.write(
        file_name("body", level) + ".pvtu", [&](std::ostream &out) {
          data_out.write_pvtu_record(
            out,
            piece_names(
              "body", level, Utilities::MPI::n_mpi_processes(communicator)));
        });
      body_files.emplace_back(level, file_name("body", level) + ".pvtu");
      directory.write("body.pvd", [&](std::ostream &out) {
        DataOutBase::write_pvd_record(out, body_files);
      });
    });
  }



  // A record must not name pieces of two runs while they are replaced one by
  // one, and a run on more processes may have left more of them. So what names
  // them goes first: the entry of the level, then the record.
  template <int dim>
  void
  FieldWriter<dim>::remove_old_pieces(const std::string   &what,
                                      const unsigned int   level,
                                      const TimesAndNames &files,
                                      const MPI_Comm       communicator) const
  {
    namespace fs = std::filesystem;
    on_first_process(communicator, [&]() {
      if (!fs::exists(directory.file(file_name(what, level) + ".pvtu")))
        return;
      if (files.empty())
        fs::remove(directory.file(what + ".pvd"));
      else
        directory.write(what + ".pvd", [&](std::ostream &out) {
          DataOutBase::write_pvd_record(out, files);
        });
      fs::remove(directory.file(file_name(what, level) + ".pvtu"));
      std::vector<fs::path> pieces;
      for (const auto &entry : fs::directory_iterator(directory.path()))
        {
          const auto file = run_file(entry.path().filename().string());
          if (file && file->what == what && file->ending == "vtu" &&
              file->level == static_cast<int>(level) && entry.is_regular_file())
            pieces.push_back(entry.path());
        }
      for (const fs::path &piece : pieces)
        fs::remove(piece);
    });
  }



  // Corners of different cells are different points, although that takes more
  // room than to keep each vertex once: stresses jump.
  //
  // On a coarse mesh there may be processes without any cell, which deal.II 9.4
  // does not want to write. So only those with cells take part, and the first
  // of them writes the description of what they have written.
  template <int dim>
  void
  FieldWriter<dim>::write_body_hdf5(const unsigned int  level,
                                    const DataOut<dim> &data_out,
                                    const bool          has_cells,
                                    const MPI_Comm      communicator)
  {
    DataOutBase::DataOutFilter data(
      DataOutBase::DataOutFilterFlags(/*filter_duplicate_vertices=*/false,
                                      /*xdmf_hdf5_output=*/true));
    data_out.write_filtered_data(data);

    const unsigned int rank   = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int writer = Utilities::MPI::min(
      has_cells ? rank : Utilities::MPI::n_mpi_processes(communicator),
      communicator);
    MPI_Comm those_with_cells;
    MPI_Comm_split(
      communicator, has_cells ? 0 : MPI_UNDEFINED, rank, &those_with_cells);

    // Points and data have double precision, and there is a header.
    std::uint64_t size = 0;
    if (has_cells)
      {
        unsigned int n_numbers = 3;
        for (unsigned int i = 0; i < data.n_data_sets(); ++i)
          n_numbers += data.get_data_set_dim(i);
        size = sizeof(double) * n_numbers * data.n_nodes() +
          sizeof(unsigned int) * GeometryInfo<dim>::vertices_per_cell *
            data.n_cells();
      }
    size = Utilities::MPI::sum(size, communicator) + (1 << 14);

    const std::string name = file_name("body", level) + ".h5";
    XDMFEntry         entry;
    write_together_then_rename(
      directory.file(name),
      communicator,
      size,
      [&](const std::string &temporary) {
        if (has_cells)
          {
            data_out.write_hdf5_parallel(data, temporary, those_with_cells);
            // In the description names are relative to its own place.
            entry =
              data_out.create_xdmf_entry(data, name, level, those_with_cells);
          }
      });
    if (has_cells)
      MPI_Comm_free(&those_with_cells);

    body_entries.push_back(
      Utilities::MPI::broadcast(communicator, entry, writer));
    on_all_processes(communicator, [&]() {
      if (rank == writer)
        write_then_rename(
          directory.file("body.xdmf"), [&](const std::string &temporary) {
            data_out.write_xdmf_file(body_entries, temporary, MPI_COMM_SELF);
          });
    });
  }



  // There are few faces on the contact boundary, and what we know there are
  // nodal values. We therefore give the corners of each face to deal.II's
  // output functions directly.
  template <int dim>
  void
  FieldWriter<dim>::write_contact_boundary(
    const unsigned int                     level,
    const LevelFields<dim>                &fields,
    const std::vector<ContactRecord<dim>> &contact)
  {
    const Mapping<dim>              &mapping      = fields.mapping;
    const DoFHandler<dim>           &dof_handler  = fields.dof_handler;
    const AffineConstraints<double> &constraints  = fields.hanging_nodes;
    const VectorType                &displacement = fields.displacement;

    // Every process knows its own nodes, but its faces have corners that others
    // own. So the data travel like displacements do: in vectors with room for
    // dim numbers per node, as many of them as it takes.
    constexpr unsigned int n_data    = std::tuple_size<ContactData<dim>>::value;
    constexpr unsigned int n_vectors = (n_data + dim - 1) / dim;
    std::array<VectorType, n_vectors> nodal_data;
    for (VectorType &v : nodal_data)
      v.reinit(displacement);
    for (const ContactRecord<dim> &record : contact)
      {
        const ContactData<dim> data = contact_data(record);
        for (unsigned int i = 0; i < n_data; ++i)
          nodal_data[i / dim](record.dof + i % dim) = data[i];
      }
    for (VectorType &v : nodal_data)
      v.update_ghost_values();

    // A node is a contact node, or hangs between contact nodes, or is neither
    // because its displacement is prescribed: then it shows no stress.
    const auto data_at = [&](const types::global_dof_index dof) {
      ContactData<dim> data{};
      const auto       add = [&](const types::global_dof_index node,
                           const double                  weight) {
        for (unsigned int i = 0; i < n_data; ++i)
          data[i] += weight * nodal_data[i / dim](node + i % dim);
      };
      if (!constraints.is_constrained(dof))
        add(dof, 1.);
      else if (constraints.get_constraint_entries(dof) != nullptr)
        for (const auto &[master, weight] :
             *constraints.get_constraint_entries(dof))
          add(master, weight);
      return data;
    };

    std::vector<DataOutBase::Patch<dim - 1, dim>> patches;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          {
            const auto face = cell->face(f);
            if (!face->at_boundary() || face->boundary_id() != contact_boundary)
              continue;

            DataOutBase::Patch<dim - 1, dim> patch;
            patch.patch_index    = patches.size();
            patch.n_subdivisions = 1;
            patch.reference_cell = face->reference_cell();
            patch.data.reinit(std::tuple_size<ContactData<dim>>::value,
                              face->n_vertices());
            const auto cell_vertices = mapping.get_vertices(cell);
            for (const unsigned int v : face->vertex_indices())
              {
                for (const unsigned int w : cell->vertex_indices())
                  if (cell->vertex_index(w) == face->vertex_index(v))
                    patch.vertices[v] = cell_vertices[w];

                ContactData<dim> data = data_at(face->vertex_dof_index(v, 0));
                // The displacement is known everywhere.
                for (unsigned int c = 0; c < dim; ++c)
                  data[c] = displacement(face->vertex_dof_index(v, c));
                for (unsigned int i = 0; i < data.size(); ++i)
                  patch.data(i, v) = data[i];
              }
            patches.push_back(patch);
          }

    const std::vector<std::string> names  = contact_data_names<dim>();
    const NonscalarRanges          ranges = contact_data_ranges<dim>();
    const DataOutBase::VtkFlags    flags  = vtk_flags(level);

    const MPI_Comm communicator = Compatibility::mpi_communicator(dof_handler);
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    remove_old_pieces("contact", level, contact_files, communicator);
    on_all_processes(communicator, [&]() {
      directory.write(
        piece_name("contact", level, rank), [&](std::ostream &out) {
          DataOutBase::write_vtu(patches, names, ranges, flags, out);
        });
    });

    on_first_process(communicator, [&]() {
      directory.write(
        file_name("contact", level) + ".pvtu", [&](std::ostream &out) {
          DataOutBase::write_pvtu_record(
            out,
            piece_names(
              "contact", level, Utilities::MPI::n_mpi_processes(communicator)),
            names,
            ranges,
            flags);
        });
      contact_files.emplace_back(level, file_name("contact", level) + ".pvtu");
      directory.write("contact.pvd", [&](std::ostream &out) {
        DataOutBase::write_pvd_record(out, contact_files);
      });
    });
  }



  template class FieldWriter<2>;
  template class FieldWriter<3>;
} // namespace Friction
