// Checkpoints: what was written is read again, on as many processes or on
// fewer; what is left of unfinished ones is never read, and removed in time.

#include <common/compatibility.h>
#include <common/output/checkpoint.h>
#include <common/parallel/collective_error.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>

#include <deal.II/grid/grid_generator.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

using namespace dealii;
using namespace Friction;

namespace
{
  using VectorType = LinearAlgebra::distributed::Vector<double>;
  template <int dim>
  using Mesh = parallel::distributed::Triangulation<dim>;



  // Whether this process is the one that prints.
  bool
  first(const MPI_Comm communicator = MPI_COMM_WORLD)
  {
    return Utilities::MPI::this_mpi_process(communicator) == 0;
  }



  template <typename Function>
  void
  try_to(const Function &function)
  {
    std::string caught = "nothing";
    try
      {
        function();
      }
    catch (const InputError &error)
      {
        caught = error.what();
      }
    if (first())
      std::cout << "  error: " << caught << std::endl;
  }



  void
  list(const RunDirectory &directory)
  {
    MPI_Barrier(MPI_COMM_WORLD);
    if (!first())
      return;
    std::set<std::string> names;
    for (const auto &entry :
         std::filesystem::directory_iterator(directory.path()))
      names.insert(entry.path().filename().string());
    std::cout << "  files:";
    for (const std::string &name : names)
      std::cout << ' ' << name;
    std::cout << std::endl;
  }



  // Something that is different at all nodes and in all components; some of the
  // values vanish up to rounding.
  template <int dim>
  double
  value(const Point<dim> &p, const unsigned int component)
  {
    return std::sin(3.14159265358979 * p[0]) * (component + 1) +
      p[dim - 1] * p[dim - 1];
  }



  template <int dim>
  VectorType
  empty_vector(const DoFHandler<dim> &dof_handler)
  {
    return VectorType(dof_handler.locally_owned_dofs(),
                      DoFTools::extract_locally_relevant_dofs(dof_handler),
                      Compatibility::mpi_communicator(dof_handler));
  }



  // Calls f(dof, value) for all dofs that this process owns.
  template <int dim, typename Function>
  void
  for_owned(const DoFHandler<dim> &dof_handler, const Function &f)
  {
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int c = 0; c < dim; ++c)
            {
              const auto dof = cell->vertex_dof_index(v, c);
              if (dof_handler.locally_owned_dofs().is_element(dof))
                f(dof, value(cell->vertex(v), c));
            }
  }



  template <int dim>
  void
  save(const Checkpoints &checkpoints, const unsigned int level)
  {
    Mesh<dim> mesh(MPI_COMM_WORLD,
                   Triangulation<dim>::limit_level_difference_at_vertices,
                   Mesh<dim>::construct_multigrid_hierarchy);
    GridGenerator::subdivided_hyper_rectangle(
      mesh,
      std::vector<unsigned int>(dim, 2),
      Point<dim>(),
      dim == 2 ? Point<dim>(1., 1.) : Point<dim>(1., 1., 1.));
    mesh.refine_global(1);
    for (unsigned int i = 0; i < level; ++i)
      {
        for (const auto &cell : mesh.active_cell_iterators())
          if (cell->is_locally_owned() && cell->center().norm() < 0.4)
            cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
      }

    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dof_handler(mesh);
    dof_handler.distribute_dofs(fe);
    VectorType u = empty_vector(dof_handler), zero = empty_vector(dof_handler);
    for_owned(dof_handler,
              [&](const types::global_dof_index dof, const double value) {
                u(dof) = value;
              });

    const std::string text =
      "record of " + std::to_string(mesh.n_global_active_cells()) + " cells";
    checkpoints.save(level,
                     std::vector<char>(text.begin(), text.end()),
                     mesh,
                     dof_handler,
                     {&u, &zero});
  }



  template <int dim>
  void
  load(const RunDirectory &directory, const MPI_Comm communicator)
  {
    const Checkpoints  checkpoints(directory, communicator);
    const unsigned int level = checkpoints.last_level();
    const auto         bytes = checkpoints.record(level);

    Mesh<dim> mesh(communicator,
                   Triangulation<dim>::limit_level_difference_at_vertices,
                   Mesh<dim>::construct_multigrid_hierarchy);
    GridGenerator::subdivided_hyper_rectangle(
      mesh,
      std::vector<unsigned int>(dim, 2),
      Point<dim>(),
      dim == 2 ? Point<dim>(1., 1.) : Point<dim>(1., 1., 1.));
    checkpoints.load_mesh(level, mesh);

    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dof_handler(mesh);
    dof_handler.distribute_dofs(fe);
    dof_handler.distribute_mg_dofs();
    VectorType u = empty_vector(dof_handler), zero = empty_vector(dof_handler);
    Checkpoints::load_vectors(dof_handler,
                              std::vector<VectorType *>{&u, &zero});

    bool same = true;
    for_owned(dof_handler,
              [&](const types::global_dof_index dof, const double value) {
                same = same && u(dof) == value && zero(dof) == 0.;
              });
    same = Utilities::MPI::min(same ? 1 : 0, communicator) == 1;
    if (first(communicator))
      std::cout << "  level " << level << ", "
                << std::string(bytes.begin(), bytes.end()) << ", "
                << mesh.n_global_active_cells() << " cells, vectors "
                << (same ? "the same" : "DIFFERENT") << std::endl;
  }



  template <int dim>
  void
  test()
  {
    const std::string name = "checkpoint-test-" + std::to_string(dim);
    on_first_process(MPI_COMM_WORLD,
                     [&]() { std::filesystem::remove_all(name); });
    const RunDirectory directory(name, MPI_COMM_WORLD);
    const Checkpoints  checkpoints(directory, MPI_COMM_WORLD);
    try_to([&]() { checkpoints.last_level(); });

    // Left over by runs that were killed while they wrote one, or while they
    // removed one; and something that only looks like one.
    on_first_process(MPI_COMM_WORLD, [&]() {
      for (const std::string part :
           {"checkpoint.part", "checkpoint-01.part", "checkpoint-12.part"})
        {
          std::filesystem::create_directory(directory.file(part));
          std::ofstream(directory.file(part + "/record")) << "half";
        }
      std::filesystem::create_directory(directory.file("checkpoint-77"));
      std::filesystem::create_directory(directory.file("checkpoint-notes"));
    });
    try_to([&]() { checkpoints.last_level(); });
    for (unsigned int level = 1; level < 4; ++level)
      save<dim>(checkpoints, level);
    list(directory);

    load<dim>(directory, MPI_COMM_WORLD);

    // The same on the first half of the processes.
    const unsigned int n    = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    MPI_Comm           half;
    MPI_Comm_split(MPI_COMM_WORLD, 2 * rank < n ? 0 : 1, rank, &half);
    if (2 * rank < n)
      load<dim>(directory, half);
    MPI_Comm_free(&half);

    // A mesh that has got lost is no reason to fall over.
    MPI_Barrier(MPI_COMM_WORLD);
    on_first_process(MPI_COMM_WORLD, [&]() {
      std::filesystem::remove(directory.file("checkpoint-03/mesh.info"));
    });
    try_to([&]() { load<dim>(directory, MPI_COMM_WORLD); });

    checkpoints.remove_all();
    list(directory);
  }
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test<2>();
  test<3>();
}
