// Checkpoints: what was written is read again, on as many processes or on
// fewer; what is left of unfinished ones is never read, and removed in time.
// One that is damaged is found, and the one before takes its place.

#include <common/compatibility.h>
#include <common/output/checkpoint.h>
#include <common/parallel/collective_error.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>

#include <deal.II/grid/grid_generator.h>

#include <tests/support/check.h>
#include <tests/support/random.h>
#include <tests/support/test.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>

using namespace dealii;
using namespace Friction;

namespace
{
  // Whether the system can take room for a file that is not yet written.
  bool knows_room = true;
} // namespace



// This one takes the place of the function of the system, in the library as
// well.
extern "C" int
fallocate(int descriptor, int mode, off_t offset, off_t length)
{
  if (knows_room)
    return syscall(SYS_fallocate, descriptor, mode, offset, length);
  errno = EOPNOTSUPP;
  return -1;
}



namespace test_checkpoint
{
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
  save(const Checkpoints &checkpoints,
       const unsigned int level,
       const MPI_Comm     communicator = MPI_COMM_WORLD)
  {
    Mesh<dim> mesh(communicator,
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
                     dof_handler,
                     {&u, &zero});
  }



  template <int dim>
  void
  load(const RunDirectory &directory, const MPI_Comm communicator)
  {
    const Checkpoints  checkpoints(directory, communicator);
    const unsigned int level = checkpoints.find_last().level;
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



  // The contents of a file are exchanged for others, by the first process.
  void
  write(const std::string &file, const std::string &contents)
  {
    on_first_process(MPI_COMM_WORLD, [&]() {
      std::ofstream(file, std::ios::binary) << contents;
    });
  }



  std::string
  read(const std::string &file)
  {
    std::ifstream      in(file, std::ios::binary);
    std::ostringstream contents;
    contents << in.rdbuf();
    MPI_Barrier(MPI_COMM_WORLD);
    return contents.str();
  }



  // Whatever happens to a file of the last checkpoint, the one before is found.
  template <int dim>
  void
  damage(const RunDirectory &directory, const Checkpoints &checkpoints)
  {
    const std::string     last = directory.file("checkpoint-03/");
    std::set<std::string> files;
    for (const auto &entry : std::filesystem::directory_iterator(last))
      files.insert(entry.path().filename().string());
    Tests::check_everywhere(
      files.count("record") == 1 && files.count("mesh") == 1 &&
        files.count("mesh.info") == 1 && files.count("mesh_fixed.data") == 1 &&
        files.count("manifest") == 1,
      "all files are there");
    MPI_Barrier(MPI_COMM_WORLD);

    Tests::Random random(dim);
    bool          all   = true;
    const auto    check = [&](const std::string &file) {
      const Checkpoints::Last found = checkpoints.find_last();
      all                           = all && found.level == 2 &&
        (!first() || found.warning.find("'" + file + "'") != std::string::npos);
      MPI_Barrier(MPI_COMM_WORLD);
    };
    for (const std::string &file : files)
      {
        const std::string contents = read(last + file);
        for (unsigned int i = 0; i < 20; ++i)
          {
            const unsigned int bit     = random.below(8 * contents.size());
            std::string        damaged = contents;
            damaged[bit / 8]           = damaged[bit / 8] ^ (1 << bit % 8);
            write(last + file, damaged);
            check(file);
            write(last + file,
                  contents.substr(0, random.below(contents.size())));
            check(file);
          }
        on_first_process(MPI_COMM_WORLD,
                         [&]() { std::filesystem::remove(last + file); });
        check(file);
        write(last + file, contents);
      }
    write(last + "more", "");
    check("more");
    Tests::check_everywhere(all, "all damage to the last one is found");
    load<dim>(directory, MPI_COMM_WORLD);
    on_first_process(MPI_COMM_WORLD,
                     [&]() { std::filesystem::remove(last + "more"); });
    Tests::check_everywhere(checkpoints.find_last().level == 3,
                            "without damage it is the last one again");

    // Both of them.
    const std::string before   = directory.file("checkpoint-02/record");
    const std::string contents = read(before);
    write(before, contents.substr(1));
    on_first_process(MPI_COMM_WORLD,
                     [&]() { std::filesystem::remove(last + "mesh.info"); });
    try_to([&]() { checkpoints.find_last(); });
    write(before, contents);
    if (first())
      std::cout << "  " << checkpoints.find_last().warning << std::endl;
    else
      checkpoints.find_last();
  }



  // Files that may not get longer than a limit are cut off without a word from
  // MPI, which is found out here even if it could not be known before.
  template <int dim>
  void
  cut_off(const RunDirectory &directory)
  {
    if (!first())
      return;
    const RunDirectory alone(directory.file("alone"));
    const Checkpoints  checkpoints(alone, MPI_COMM_SELF);
    save<dim>(checkpoints, 2, MPI_COMM_SELF);
    save<dim>(checkpoints, 3, MPI_COMM_SELF);
    const auto size =
      std::filesystem::file_size(alone.file("checkpoint-03/mesh_fixed.data"));

    rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    for (const bool is_asked_before : {true, false})
      for (const unsigned int missing : {1, 8, 1000})
        {
          knows_room           = is_asked_before;
          const rlim_t before  = limit.rlim_cur;
          limit.rlim_cur       = size - missing;
          std::string sentence = "nothing";
          setrlimit(RLIMIT_FSIZE, &limit);
          try
            {
              save<dim>(checkpoints, 3, MPI_COMM_SELF);
            }
          catch (const InputError &error)
            {
              sentence = error.what();
            }
          limit.rlim_cur = before;
          setrlimit(RLIMIT_FSIZE, &limit);
          Tests::check(
            sentence.find("' cannot be written") != std::string::npos &&
              checkpoints.find_last().level == 3 &&
              checkpoints.find_last().warning.empty() &&
              !std::filesystem::exists(alone.file("checkpoint.part")),
            "a file without its last " + std::to_string(missing) + " bytes");
        }
    std::filesystem::remove_all(alone.path());
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
    try_to([&]() { checkpoints.find_last(); });

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
    try_to([&]() { checkpoints.find_last(); });
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

    damage<dim>(directory, checkpoints);
    cut_off<dim>(directory);
    list(directory);

    checkpoints.remove_after(2);
    list(directory);
    checkpoints.remove_all();
    list(directory);
  }
} // namespace test_checkpoint

TEST(checkpoint)
{
  std::signal(SIGXFSZ, SIG_IGN);
  test<2>();
  test<3>();
}
