// The fields of two levels, in 2D and in 3D with a hanging node on the contact
// boundary: all files are there, they name each other, and the numbers of
// points and cells are right. Once in each format of the body. And on a mesh of
// distorted cells with hanging nodes the numbers in the files are those of
// points and cells, computed again with FEValues.

#include <common/compatibility.h>
#include <common/output/fields.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/hdf5.h>
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <deal.II/lac/full_matrix.h>

#include <deal.II/numerics/vector_tools_interpolate.h>

#include <tests/support/check.h>
#include <tests/support/test.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

using namespace dealii;
using namespace Friction;

namespace test_fields
{
  void
  print_lines_with(const std::string &file, const std::set<std::string> &words)
  {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
      for (const std::string &word : words)
        if (line.find(word) != std::string::npos)
          {
            std::cout << "    " << line << std::endl;
            break;
          }
  }



  template <int dim>
  void
  test(const FieldFormat format)
  {
    const std::string name = "fields-test-" + std::to_string(dim) +
      (format == FieldFormat::hdf5 ? "-hdf5" : "");
    on_first_process(MPI_COMM_WORLD,
                     [&]() { std::filesystem::remove_all(name); });
    const RunDirectory directory(name, MPI_COMM_WORLD);
    FieldWriter<dim>   writer(directory, Material(2.5, .25), {2}, format);

    parallel::distributed::Triangulation<dim> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation, 0., 1., true);
    triangulation.refine_global(1);

    for (unsigned int level = 0; level < 2; ++level)
      {
        if (level == 1)
          {
            for (const auto &cell : triangulation.active_cell_iterators())
              if (cell->is_locally_owned() && cell->center().norm() < 0.5)
                cell->set_refine_flag();
            triangulation.execute_coarsening_and_refinement();
          }

        const FESystem<dim> fe(FE_Q<dim>(1), dim);
        DoFHandler<dim>     dof_handler(triangulation);
        dof_handler.distribute_dofs(fe);
        AffineConstraints<double> constraints = Compatibility::make_constraints(
          dof_handler.locally_owned_dofs(),
          DoFTools::extract_locally_relevant_dofs(dof_handler));
        DoFTools::make_hanging_node_constraints(dof_handler, constraints);
        constraints.close();

        VectorType u(dof_handler.locally_owned_dofs(),
                     DoFTools::extract_locally_relevant_dofs(dof_handler),
                     MPI_COMM_WORLD);
        u = 0.25;
        u.update_ghost_values();

        std::map<types::global_dof_index, ContactRecord<dim>> nodes;
        for (const auto &cell : dof_handler.active_cell_iterators())
          for (const auto &face : cell->face_iterators())
            if (!cell->is_artificial() && face->at_boundary() &&
                face->boundary_id() == 2)
              for (const unsigned int v : face->vertex_indices())
                {
                  const auto dof = face->vertex_dof_index(v, 0);
                  if (constraints.is_constrained(dof) ||
                      !dof_handler.locally_owned_dofs().is_element(dof))
                    continue;
                  ContactRecord<dim> record;
                  record.dof       = dof;
                  record.point     = face->vertex(v);
                  record.normal[1] = -1.;
                  record.measure   = 0.5;
                  record.force[0]  = 0.25;
                  record.force[1]  = 1.;
                  record.gap       = 0.125;
                  record.state     = 2;
                  nodes[dof]       = record;
                }
        std::vector<ContactRecord<dim>> contact;
        for (const auto &node : nodes)
          contact.push_back(node.second);

        const Vector<float>  errors(triangulation.n_active_cells());
        const MappingQ1<dim> mapping;
        writer.write_level(
          level, {mapping, dof_handler, constraints, u, &errors}, contact);
      }

    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
      return;
    std::cout << dim << "D" << std::endl;
    std::set<std::string> names;
    for (const auto &entry : std::filesystem::directory_iterator(name))
      names.insert(entry.path().filename().string());
    for (const std::string &file : names)
      {
        std::cout << "  " << file << std::endl;
        print_lines_with(directory.file(file),
                         {"<Piece", "<DataSet ", "<Attribute", "Dimensions"});
      }
  }



  // One array of a file: what stands behind the number of its bytes, behind the
  // XML.
  template <typename Number>
  std::vector<Number>
  read_array(const std::string &file, const std::string &beginning)
  {
    std::ifstream     in(file, std::ios::binary);
    std::stringstream all;
    all << in.rdbuf();
    const std::string text   = all.str();
    const std::size_t tag    = text.find("<DataArray " + beginning);
    const std::size_t offset = text.find("offset=\"", tag) + 8;
    const char       *data   = text.data() +
      text.find('_', text.find("<AppendedData")) + 1 +
      std::stoul(text.substr(offset));
    std::uint64_t n_bytes;
    std::memcpy(&n_bytes, data, sizeof(n_bytes));
    std::vector<Number> values(n_bytes / sizeof(Number));
    std::memcpy(values.data(), data + sizeof(n_bytes), n_bytes);
    return values;
  }



  template <int dim>
  class WavyDisplacement : public Function<dim>
  {
  public:
    WavyDisplacement()
      : Function<dim>(dim)
    {}

    double
    value(const Point<dim> &p, const unsigned int c) const override
    {
      return std::sin((1. + c) * p[0] - 2. * p[1]) + c * p[0] * p[dim - 1];
    }
  };



  template <int dim>
  void
  test_values(const VolumetricStrain kind)
  {
    const std::string name = "fields-test-values";
    on_first_process(MPI_COMM_WORLD,
                     [&]() { std::filesystem::remove_all(name); });
    const RunDirectory directory(name, MPI_COMM_WORLD);
    const Material     material(2.5, .25, kind);
    FieldWriter<dim>   writer(
      directory, material, {2}, FieldFormat::vtu, /*principal_stresses=*/true);

    Triangulation<dim> coarse;
    GridGenerator::subdivided_hyper_cube(coarse, 2);
    GridTools::transform(
      [](Point<dim> p) {
        p[0] += 0.2 * p[1] * p[dim - 1];
        p[1] -= 0.1 * p[0] * p[1];
        return p;
      },
      coarse);
    parallel::distributed::Triangulation<dim> triangulation(MPI_COMM_WORLD);
    triangulation.copy_triangulation(coarse);
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[0] < 0.5)
        cell->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();

    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dof_handler(triangulation);
    dof_handler.distribute_dofs(fe);
    const IndexSet relevant =
      DoFTools::extract_locally_relevant_dofs(dof_handler);
    AffineConstraints<double> constraints = Compatibility::make_constraints(
      dof_handler.locally_owned_dofs(), relevant);
    DoFTools::make_hanging_node_constraints(dof_handler, constraints);
    constraints.close();
    const MappingQ1<dim> mapping;
    VectorType u(dof_handler.locally_owned_dofs(), relevant, MPI_COMM_WORLD);
    VectorTools::interpolate(mapping, dof_handler, WavyDisplacement<dim>(), u);
    constraints.distribute(u);
    u.update_ghost_values();
    Vector<float> errors(triangulation.n_active_cells());
    for (unsigned int i = 0; i < errors.size(); ++i)
      errors(i) = 1.F + i;
    writer.write_level(0, {mapping, dof_handler, constraints, u, &errors}, {});

    const std::string file =
      directory.file("body-00." +
                     Utilities::int_to_string(
                       Utilities::MPI::this_mpi_process(MPI_COMM_WORLD), 4) +
                     ".vtu");
    const auto field = [&](const std::string &field_name) {
      return read_array<float>(file,
                               "type=\"Float32\" Name=\"" + field_name + '"');
    };
    const auto points =
      read_array<double>(file, "type=\"Float64\" NumberOfComponents");
    const auto corners =
      read_array<std::int32_t>(file, "type=\"Int32\" Name=\"connectivity\"");
    const std::vector<float> displacement = field("displacement"),
                             error        = field("estimated_error"),
                             mises        = field("von_Mises_stress"),
                             tensor       = field("stress");
    const std::array<std::vector<float>, 3> principal = {
      {field("principal_stress_1"),
       field("principal_stress_2"),
       field("principal_stress_3")}};
    // Of the symmetric tensor, in VTK's order.
    const unsigned int component[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

    // deal.II counts corners row by row, VTK goes around.
    const std::array<unsigned int, 8> order = {{0, 1, 3, 2, 4, 5, 7, 6}};
    FEValues<dim> middle(mapping, fe, QMidpoint<dim>(), update_gradients);
    FEValues<dim> inside(
      mapping, fe, QGauss<dim>(3), update_gradients | update_JxW_values);
    const FEValuesExtractors::Vector     vector(0);
    std::vector<SymmetricTensor<2, dim>> strains(1);
    std::vector<double>    divergences(inside.n_quadrature_points);
    std::set<unsigned int> vertices;
    unsigned int           n_cells = 0;
    double of_points = 0., of_displacements = 0., of_errors = 0.,
           of_stresses = 0., of_principal = 0.;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          for (const unsigned int k : cell->vertex_indices())
            {
              const unsigned int v = order[k];
              const std::int32_t point =
                corners.at(n_cells * cell->n_vertices() + k);
              vertices.insert(cell->vertex_index(v));
              for (unsigned int c = 0; c < 3; ++c)
                {
                  const double place = c < dim ? cell->vertex(v)[c] : 0.;
                  const double value =
                    c < dim ? u(cell->vertex_dof_index(v, c)) : 0.;
                  of_points = std::max(
                    of_points, std::abs(points.at(3 * point + c) - place));
                  of_displacements =
                    std::max(of_displacements,
                             std::abs(displacement.at(3 * point + c) - value));
                }
            }

          middle.reinit(cell);
          middle[vector].get_function_symmetric_gradients(u, strains);
          double theta = trace(strains[0]);
          if (kind == VolumetricStrain::mean)
            {
              inside.reinit(cell);
              inside[vector].get_function_divergences(u, divergences);
              double volume = 0.;
              theta         = 0.;
              for (unsigned int q = 0; q < divergences.size(); ++q)
                {
                  volume += inside.JxW(q);
                  theta += divergences[q] * inside.JxW(q);
                }
              theta /= volume;
            }
          double s[3][3] = {};
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              s[i][j] = (i == j ? material.lambda() * theta : 0.) +
                (i < dim && j < dim ? 2. * material.mu() * strains[0][i][j]
                                    : 0.);
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = i; j < 3; ++j)
              of_stresses = std::max(
                of_stresses,
                std::abs(tensor.at(6 * n_cells + component[i][j]) - s[i][j]));
          // Principal stresses are the zeros of det(s - p), from the largest to
          // the smallest, and there are no others.
          double sum = 0.;
          for (unsigned int k = 0; k < 3; ++k)
            {
              const double p = principal[k].at(n_cells);
              Tensor<2, 3> shifted;
              for (unsigned int i = 0; i < 3; ++i)
                for (unsigned int j = 0; j < 3; ++j)
                  shifted[i][j] = s[i][j] - (i == j ? p : 0.);
              of_principal =
                std::max(of_principal, std::abs(determinant(shifted)));
              if (k > 0 && p > principal[k - 1].at(n_cells))
                of_principal = 1.;
              sum += p;
            }
          of_principal =
            std::max(of_principal, std::abs(sum - s[0][0] - s[1][1] - s[2][2]));
          const double squared_mises =
            .5 * (s[0][0] - s[1][1]) * (s[0][0] - s[1][1]) +
            .5 * (s[1][1] - s[2][2]) * (s[1][1] - s[2][2]) +
            .5 * (s[2][2] - s[0][0]) * (s[2][2] - s[0][0]) +
            3. * (s[0][1] * s[0][1] + s[1][2] * s[1][2] + s[0][2] * s[0][2]);
          of_stresses =
            std::max(of_stresses,
                     std::abs(mises.at(n_cells) - std::sqrt(squared_mises)));
          of_errors = std::max<double>(
            of_errors,
            std::abs(error.at(n_cells) - errors(cell->active_cell_index())));
          ++n_cells;
        }

    const std::string where = std::to_string(dim) + "D, " +
      (kind == VolumetricStrain::mean ? "mean" : "pointwise") +
      " volumetric strain: ";
    Tests::check_everywhere(
      points.size() == 3 * vertices.size() &&
        displacement.size() == points.size() && error.size() == n_cells,
      where + "each vertex is one point, each cell a cell");
    Tests::check_everywhere(of_points < 1e-15 && of_displacements < 1e-6,
                            where + "places and displacements of corners");
    Tests::check_everywhere(of_stresses < 1e-5,
                            where + "stresses in the middles of cells");
    Tests::check_everywhere(of_principal < 1e-4, where + "principal stresses");
    Tests::check_everywhere(of_errors == 0., where + "errors of cells");
  }



  // In the unit square u=(xy,0) has the divergence y, with 1/4 and 3/4 in the
  // middles, and as means, of two rows of cells. With lambda = 1 this is the
  // third normal stress. Of a single cell, all processes but one have nothing
  // to write.
  void
  test_stresses(const VolumetricStrain kind, const unsigned int n_refinements)
  {
    const std::string name = "fields-test-stresses";
    on_first_process(MPI_COMM_WORLD,
                     [&]() { std::filesystem::remove_all(name); });
    const RunDirectory directory(name, MPI_COMM_WORLD);
    FieldWriter<2>     writer(
      directory, Material(2.5, .25, kind), {2}, FieldFormat::hdf5);

    parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation);
    triangulation.refine_global(n_refinements);
    const FESystem<2> fe(FE_Q<2>(1), 2);
    DoFHandler<2>     dof_handler(triangulation);
    dof_handler.distribute_dofs(fe);
    VectorType u(dof_handler.locally_owned_dofs(),
                 DoFTools::extract_locally_relevant_dofs(dof_handler),
                 MPI_COMM_WORLD);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int v : cell->vertex_indices())
          if (dof_handler.locally_owned_dofs().is_element(
                cell->vertex_dof_index(v, 0)))
            u(cell->vertex_dof_index(v, 0)) =
              cell->vertex(v)[0] * cell->vertex(v)[1];
    u.update_ghost_values();
    const MappingQ1<2>              mapping;
    const AffineConstraints<double> constraints;
    writer.write_level(0, {mapping, dof_handler, constraints, u}, {});

    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
      return;
    std::cout << (kind == VolumetricStrain::mean ? "mean" : "pointwise")
              << " volumetric strain, " << (n_refinements == 0 ? 1 : 4)
              << " cells: stress_zz";
    const HDF5::File file(directory.file("body-00.h5"),
                          HDF5::File::FileAccessMode::open);
    const auto       stresses =
      file.open_dataset("stress_zz").read<FullMatrix<double>>();
    std::set<double> values;
    for (unsigned int i = 0; i < stresses.m(); ++i)
      values.insert(stresses(i, 0));
    for (const double value : values)
      std::cout << ' ' << value;
    std::cout << std::endl;
  }
} // namespace test_fields

TEST(fields)
{
  for (const FieldFormat format : {FieldFormat::vtu, FieldFormat::hdf5})
    {
      test<2>(format);
      test<3>(format);
    }
  for (const VolumetricStrain kind :
       {VolumetricStrain::pointwise, VolumetricStrain::mean})
    {
      test_values<2>(kind);
      test_values<3>(kind);
    }
  test_stresses(VolumetricStrain::pointwise, 1);
  test_stresses(VolumetricStrain::mean, 1);
  test_stresses(VolumetricStrain::mean, 0);
}
