// The fields of two levels, in 2D and in 3D with a hanging node on the contact
// boundary: all files are there, they name each other, and the numbers of
// points and cells are right. Once in each format of the body.

#include <common/compatibility.h>
#include <common/output/fields.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/hdf5.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/lac/full_matrix.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>

using namespace dealii;
using namespace Friction;

namespace
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
    FieldWriter<dim>   writer(directory, Material(2.5, .25), 2, format);

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

        LinearAlgebra::distributed::Vector<double> u(
          dof_handler.locally_owned_dofs(),
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

        const Vector<float> errors(triangulation.n_active_cells());
        const MappingQ1<dim> mapping;
        writer.write_level(level,
                           {mapping, dof_handler, constraints, u, &errors},
                           contact);
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



  // In the unit square u=(xy,0) has the divergence y, with means of 1/4 and 3/4
  // over two rows of cells. With lambda = 1 this is the third normal stress.
  // Of a single cell, all processes but one have nothing to write.
  void
  test_stresses(const VolumetricStrain kind, const unsigned int n_refinements)
  {
    const std::string name = "fields-test-stresses";
    on_first_process(MPI_COMM_WORLD,
                     [&]() { std::filesystem::remove_all(name); });
    const RunDirectory directory(name, MPI_COMM_WORLD);
    FieldWriter<2>     writer(
      directory, Material(2.5, .25, kind), 2, FieldFormat::hdf5);

    parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation);
    triangulation.refine_global(n_refinements);
    const FESystem<2> fe(FE_Q<2>(1), 2);
    DoFHandler<2>     dof_handler(triangulation);
    dof_handler.distribute_dofs(fe);
    LinearAlgebra::distributed::Vector<double> u(
      dof_handler.locally_owned_dofs(),
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
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const FieldFormat format : {FieldFormat::vtu, FieldFormat::hdf5})
    {
      test<2>(format);
      test<3>(format);
    }
  test_stresses(VolumetricStrain::pointwise, 1);
  test_stresses(VolumetricStrain::mean, 1);
  test_stresses(VolumetricStrain::mean, 0);
}
