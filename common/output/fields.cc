#include <common/compatibility.h>
#include <common/discretization/multilinear_cell.h>
#include <common/discretization/volumetric_strain.h>
#include <common/output/fields.h>
#include <common/output/left_overs.h>
#include <common/parallel/collective_error.h>

#include <deal.II/numerics/data_out.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <tuple>
#include <utility>

namespace Friction
{
  using namespace dealii;

  namespace
  {
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



    // Corners of cells and faces in the order of VTK, which goes around.
    constexpr std::array<unsigned int, 8> order_of_corners = {
      {0, 1, 3, 2, 4, 5, 7, 6}};



    // The points of a piece: those vertices of the mesh that its cells have,
    // each of them once.
    template <int dim>
    class PointNumbers
    {
    public:
      PointNumbers(const Triangulation<dim> &triangulation, VtuPiece &piece)
        : piece(piece)
        , numbers(triangulation.n_vertices(), unknown)
      {}

      // The point that this vertex of the mesh is, and whether it is new.
      std::pair<std::int32_t, bool>
      add(const unsigned int vertex, const Point<dim> &place)
      {
        const bool is_new = numbers[vertex] == unknown;
        if (is_new)
          {
            numbers[vertex] = static_cast<std::int32_t>(piece.n_points());
            for (unsigned int c = 0; c < 3; ++c)
              piece.points.push_back(c < dim ? place[c] : 0.);
          }
        piece.corners.push_back(numbers[vertex]);
        return {numbers[vertex], is_new};
      }

    private:
      static constexpr std::int32_t unknown = -1;

      VtuPiece                 &piece;
      std::vector<std::int32_t> numbers;
    };



    // The components of a symmetric tensor, in the order of VTK.
    constexpr unsigned int                    n_stresses   = 6;
    const std::array<std::string, n_stresses> stress_names = {{"stress_xx",
                                                               "stress_yy",
                                                               "stress_zz",
                                                               "stress_xy",
                                                               "stress_yz",
                                                               "stress_xz"}};



    // Always a 3x3 tensor: in plane strain the third normal strain is zero, but
    // the third normal stress is not.
    template <int dim>
    SymmetricTensor<2, 3>
    stress_tensor(const Tensor<2, dim> &gradient,
                  const double          volumetric_strain,
                  const Material       &material)
    {
      SymmetricTensor<2, 3> stress =
        material.lambda() * volumetric_strain * unit_symmetric_tensor<3>();
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          stress[i][j] += material.mu() * (gradient[i][j] + gradient[j][i]);
      return stress;
    }



    // The fields of the body that follow from the stress.
    class StressFields
    {
    public:
      StressFields(std::vector<VtuPiece::Field> &fields,
                   const bool                    principal_stresses)
        : principal_stresses(principal_stresses)
        , fields(fields)
        , first(fields.size())
      {
        fields.push_back({"stress", n_stresses, {}});
        fields.push_back({"von_Mises_stress", 1, {}});
        if (principal_stresses)
          for (const char *number : {"1", "2", "3"})
            fields.push_back(
              {std::string("principal_stress_") + number, 1, {}});
      }

      // Of the next cell.
      void
      add(const SymmetricTensor<2, 3> &stress) const
      {
        for (const double component : {stress[0][0],
                                       stress[1][1],
                                       stress[2][2],
                                       stress[0][1],
                                       stress[1][2],
                                       stress[0][2]})
          fields[first].values.push_back(static_cast<float>(component));
        fields[first + 1].values.push_back(
          static_cast<float>(std::sqrt(1.5) * deviator(stress).norm()));
        if (principal_stresses)
          {
            const std::array<double, 3> values = eigenvalues(stress);
            for (unsigned int i = 0; i < 3; ++i)
              fields[first + 2 + i].values.push_back(
                static_cast<float>(values[i]));
          }
      }

    private:
      const bool                    principal_stresses;
      std::vector<VtuPiece::Field> &fields;
      const std::size_t             first;
    };



    // The same fields with a tensor's components one by one, those left out
    // that are zero in the plane.
    template <int dim>
    std::vector<VtuPiece::Field>
    numbers_of_cells(const std::vector<VtuPiece::Field> &fields)
    {
      std::vector<VtuPiece::Field> numbers;
      for (const VtuPiece::Field &field : fields)
        if (field.n_components == 1)
          numbers.push_back(field);
        else
          for (unsigned int c = 0; c < (dim == 2 ? 4 : n_stresses); ++c)
            {
              numbers.push_back({stress_names[c], 1, {}});
              for (std::size_t i = c; i < field.values.size(); i += n_stresses)
                numbers.back().values.push_back(field.values[i]);
            }
      return numbers;
    }



    // All cells that this process owns, with the stresses in their middle.
    template <int dim>
    VtuPiece
    piece_of_body(const LevelFields<dim> &fields,
                  const Materials<dim>   &materials,
                  const bool              principal_stresses)
    {
      const DoFHandler<dim>           &dof_handler = fields.dof_handler;
      const VolumetricStrainField<dim> volumetric_strain(
        fields.mapping, dof_handler, materials, fields.displacement);

      VtuPiece piece(dim == 2 ? VtuPiece::Cell::quadrilateral
                              : VtuPiece::Cell::hexahedron);
      piece.point_fields.push_back({"displacement", 3, {}});
      const StressFields stresses(piece.cell_fields, principal_stresses);
      const std::size_t  modulus = piece.cell_fields.size();
      if (!materials.is_homogeneous())
        piece.cell_fields.push_back({"youngs_modulus", 1, {}});
      if (fields.cell_errors != nullptr)
        piece.cell_fields.push_back({"estimated_error", 1, {}});

      // Differences of displacements need more digits than are written.
      std::vector<Tensor<1, dim>> displacements;
      PointNumbers<dim> points(dof_handler.get_triangulation(), piece);
      using CellValues = Multilinear::CellValues<dim>;
      std::array<typename CellValues::Values, CellValues::n_corners> corners;
      const Point<dim> middle = Multilinear::middle_of_cell<dim>();
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const auto vertices = fields.mapping.get_vertices(cell);
            for (unsigned int i = 0; i < vertices.size(); ++i)
              {
                const unsigned int v = order_of_corners[i];
                const auto [point, is_new] =
                  points.add(cell->vertex_index(v), vertices[v]);
                if (is_new)
                  {
                    Tensor<1, dim> u;
                    for (unsigned int c = 0; c < dim; ++c)
                      u[c] = fields.displacement(cell->vertex_dof_index(v, c));
                    displacements.push_back(u);
                  }
                for (unsigned int c = 0; c < dim; ++c)
                  {
                    corners[v][c]       = vertices[v][c];
                    corners[v][dim + c] = displacements[point][c];
                  }
              }

            const Tensor<2, dim> gradient =
              Multilinear::PointOfCell<dim>(CellValues(corners), middle)
                .gradient;
            const Material &material = materials.of(cell);
            stresses.add(stress_tensor(
              gradient,
              volumetric_strain.value(cell, material, trace(gradient)),
              material));
            if (!materials.is_homogeneous())
              piece.cell_fields[modulus].values.push_back(
                static_cast<float>(material.youngs_modulus()));
            if (fields.cell_errors != nullptr)
              piece.cell_fields.back().values.push_back(
                (*fields.cell_errors)(cell->active_cell_index()));
          }

      for (const Tensor<1, dim> &u : displacements)
        for (unsigned int c = 0; c < 3; ++c)
          piece.point_fields[0].values.push_back(
            c < dim ? static_cast<float>(u[c]) : 0.F);
      return piece;
    }



    // What is known of a contact node: three vectors, then five numbers. Of
    // these and the displacement, what is shown in a point.
    constexpr unsigned int n_contact_vectors = 3;
    constexpr unsigned int n_contact_scalars = 5;

    const std::array<std::string, n_contact_vectors> contact_vector_names = {
      {"traction", "tangential_traction", "normal"}};
    const std::array<std::string, n_contact_scalars> contact_scalar_names = {
      {"pressure", "friction_bound", "gap", "distance", "state"}};



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
          data[c]           = traction[c];
          data[dim + c]     = traction[c] + pressure * record.normal[c];
          data[2 * dim + c] = record.normal[c];
        }
      data[3 * dim]     = pressure;
      data[3 * dim + 1] = record.friction_bound;
      data[3 * dim + 2] = record.gap;
      data[3 * dim + 3] = record.gap - record.displacement * record.normal;
      data[3 * dim + 4] = record.state;
      return data;
    }



    // Where there is contact, the tangential part of the displacement, counted
    // from where friction does.
    template <int dim>
    Tensor<1, dim>
    slip_of_point(const Tensor<1, dim>   &displacement,
                  const ContactData<dim> &data)
    {
      Tensor<1, dim> normal;
      for (unsigned int c = 0; c < dim; ++c)
        normal[c] = data[2 * dim + c];
      const double state = data[3 * dim + 4];
      if (state == 0. || normal.norm_square() == 0.)
        return Tensor<1, dim>();
      return displacement -
        (displacement * normal) / normal.norm_square() * normal;
    }



    template <int dim>
    void
    append_vector(const Tensor<1, dim> &vector, VtuPiece::Field &field)
    {
      for (unsigned int c = 0; c < 3; ++c)
        field.values.push_back(c < dim ? static_cast<float>(vector[c]) : 0.F);
    }
  } // namespace



  template <int dim>
  FieldWriter<dim>::FieldWriter(
    const RunDirectory                 &directory,
    const Materials<dim>               &materials,
    const std::set<types::boundary_id> &contact_boundary,
    const FieldFormat                   format,
    const bool                          principal_stresses)
    : directory(directory)
    , materials(materials)
    , contact_boundary(contact_boundary)
    , format(format)
    , principal_stresses(principal_stresses)
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
    const VtuPiece piece = piece_of_body(fields, materials, principal_stresses);
    if (format == FieldFormat::hdf5)
      write_body_hdf5(level, fields, piece);
    else
      write_piece("body", level, piece, fields, body_files);
  }



  template <int dim>
  void
  FieldWriter<dim>::add_to_list(TimesAndNames     &files,
                                const double       time,
                                const std::string &name)
  {
    if (!files.empty() && files.back().first == time)
      files.pop_back();
    files.emplace_back(time, name);
  }



  template <int dim>
  void
  FieldWriter<dim>::write_piece(const std::string      &what,
                                const unsigned int      level,
                                const VtuPiece         &piece,
                                const LevelFields<dim> &fields,
                                TimesAndNames          &files)
  {
    const MPI_Comm communicator =
      Compatibility::mpi_communicator(fields.dof_handler);
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    remove_old_pieces(what, level, files, communicator);
    on_all_processes(communicator, [&]() {
      directory.write(piece_name(what, level, rank),
                      [&](std::ostream &out) { write_vtu(out, piece, level); });
    });

    // The record names the pieces, which are all there now.
    on_first_process(communicator, [&]() {
      const std::string record = file_name(what, level) + ".pvtu";
      directory.write(record, [&](std::ostream &out) {
        write_pvtu(out,
                   piece,
                   piece_names(what,
                               level,
                               Utilities::MPI::n_mpi_processes(communicator)));
      });
      add_to_list(files, fields.time.value_or(level), record);
      directory.write(what + ".pvd", [&](std::ostream &out) {
        DataOutBase::write_pvd_record(out, files);
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
        directory.remove(what + ".pvd");
      else
        directory.write(what + ".pvd", [&](std::ostream &out) {
          DataOutBase::write_pvd_record(out, files);
        });
      directory.remove(file_name(what, level) + ".pvtu");
      std::vector<std::string> pieces;
      for (const auto &entry : fs::directory_iterator(directory.path()))
        {
          const std::string name = entry.path().filename().string();
          const auto        file = run_file(name);
          if (file && file->what == what && file->ending == "vtu" &&
              file->level == static_cast<int>(level) && entry.is_regular_file())
            pieces.push_back(name);
        }
      for (const std::string &piece : pieces)
        directory.remove(piece);
    });
  }



  // deal.II knows no cell data in these files. So corners of different cells
  // are different points, and what belongs to the cell stands in each of them.
  //
  // On a coarse mesh there may be processes without any cell, which deal.II 9.4
  // does not want to write. So only those with cells take part, and the first
  // of them writes the description of what they have written.
  template <int dim>
  void
  FieldWriter<dim>::write_body_hdf5(const unsigned int      level,
                                    const LevelFields<dim> &fields,
                                    const VtuPiece         &piece)
  {
    const DoFHandler<dim> &dof_handler = fields.dof_handler;
    const MPI_Comm communicator = Compatibility::mpi_communicator(dof_handler);
    const bool     has_cells    = piece.n_cells() > 0;
    const double   time         = fields.time.value_or(level);

    DataOut<dim> data_out;
    data_out.attach_dof_handler(dof_handler);
    data_out.add_data_vector(
      fields.displacement,
      std::vector<std::string>(dim, "displacement"),
      DataOut<dim>::type_dof_data,
      std::vector<DataComponentInterpretation::DataComponentInterpretation>(
        dim, DataComponentInterpretation::component_is_part_of_vector));
    const std::vector<VtuPiece::Field> cell_fields =
      numbers_of_cells<dim>(piece.cell_fields);
    std::vector<Vector<float>> cell_data(cell_fields.size());
    for (unsigned int i = 0; i < cell_data.size(); ++i)
      {
        cell_data[i].reinit(dof_handler.get_triangulation().n_active_cells());
        auto value = cell_fields[i].values.begin();
        for (const auto &cell : dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            cell_data[i](cell->active_cell_index()) = *value++;
        data_out.add_data_vector(
          cell_data[i], cell_fields[i].name, DataOut<dim>::type_cell_data);
      }
    data_out.build_patches(fields.mapping);

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
              data_out.create_xdmf_entry(data, name, time, those_with_cells);
          }
      });
    if (has_cells)
      MPI_Comm_free(&those_with_cells);

    if (!body_entries.empty() && last_entry_time == time)
      body_entries.pop_back();
    last_entry_time = time;
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

    VtuPiece piece(dim == 2 ? VtuPiece::Cell::line
                            : VtuPiece::Cell::quadrilateral);
    for (const char *name : {"displacement", "slip"})
      piece.point_fields.push_back({name, 3, {}});
    for (const std::string &name : contact_vector_names)
      piece.point_fields.push_back({name, 3, {}});
    for (const std::string &name : contact_scalar_names)
      piece.point_fields.push_back({name, 1, {}});

    PointNumbers<dim> points(dof_handler.get_triangulation(), piece);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          {
            const auto face = cell->face(f);
            if (!face->at_boundary() ||
                contact_boundary.count(face->boundary_id()) == 0)
              continue;

            const auto cell_vertices = mapping.get_vertices(cell);
            for (unsigned int i = 0; i < face->n_vertices(); ++i)
              {
                const unsigned int v = order_of_corners[i];
                Point<dim>         place;
                for (const unsigned int w : cell->vertex_indices())
                  if (cell->vertex_index(w) == face->vertex_index(v))
                    place = cell_vertices[w];
                if (!points.add(face->vertex_index(v), place).second)
                  continue;

                const ContactData<dim> data =
                  data_at(face->vertex_dof_index(v, 0));
                // The displacement is known everywhere.
                Tensor<1, dim> u, from_origin;
                for (unsigned int c = 0; c < dim; ++c)
                  {
                    const auto dof = face->vertex_dof_index(v, c);
                    u[c]           = displacement(dof);
                    from_origin[c] = fields.slip_origin == nullptr
                      ? u[c]
                      : u[c] - (*fields.slip_origin)(dof);
                  }
                auto field = piece.point_fields.begin();
                append_vector(u, *field++);
                append_vector(slip_of_point(from_origin, data), *field++);
                for (unsigned int k = 0; k < n_contact_vectors; ++k)
                  {
                    Tensor<1, dim> vector;
                    for (unsigned int c = 0; c < dim; ++c)
                      vector[c] = data[k * dim + c];
                    append_vector(vector, *field++);
                  }
                for (unsigned int k = 0; k < n_contact_scalars; ++k)
                  (field++)->values.push_back(
                    static_cast<float>(data[n_contact_vectors * dim + k]));
              }
          }

    write_piece("contact", level, piece, fields, contact_files);
  }



  template class FieldWriter<2>;
  template class FieldWriter<3>;
} // namespace Friction
