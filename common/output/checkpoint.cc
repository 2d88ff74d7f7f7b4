#include <common/compatibility.h>
#include <common/output/checkpoint.h>
#include <common/parallel/collective_error.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

namespace Friction
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    using VectorType = LinearAlgebra::distributed::Vector<double>;

    const std::string prefix     = "checkpoint";
    const std::string unfinished = ".part";



    // The level of a directory with a complete checkpoint, from its name.
    std::optional<unsigned int>
    level_of(const fs::path &path)
    {
      const std::string name = path.filename().string();
      if (name.rfind(prefix + "-", 0) != 0)
        return {};
      const std::string number = name.substr(prefix.size() + 1);
      if (number.empty() || number.size() > 6 ||
          number.find_first_not_of("0123456789") != number.npos ||
          !fs::exists(path / "record"))
        return {};
      return std::stoul(number);
    }



    // Whatever the file system complains about becomes a sentence.
    template <typename F>
    void
    with_sentence(const std::string &beginning, F &&f)
    {
      try
        {
          f();
        }
      catch (const fs::filesystem_error &error)
        {
          throw InputError(beginning + ": " + error.code().message() + ".");
        }
    }



    // The same for functions of deal.II that all processes call together.
    template <typename F>
    void
    together(const MPI_Comm communicator, const std::string &sentence, F &&f)
    {
      std::optional<std::string> error;
      try
        {
          f();
        }
      catch (const std::exception &)
        {
          error = sentence;
        }
      throw_if_any(communicator, error);
    }
  } // namespace



  Checkpoints::Checkpoints(const RunDirectory &directory,
                           const MPI_Comm      communicator)
    : directory(directory)
    , communicator(communicator)
  {}



  std::string
  Checkpoints::path(const unsigned int level) const
  {
    return directory.file(prefix + (level < 10 ? "-0" : "-") +
                          std::to_string(level));
  }



  template <int dim>
  void
  Checkpoints::save(
    const unsigned int                               level,
    const std::vector<char>                         &record,
    const parallel::distributed::Triangulation<dim> &triangulation,
    const DoFHandler<dim>                           &dof_handler,
    const std::vector<const VectorType *>           &vectors) const
  {
    const fs::path    part = directory.file(prefix + unfinished);
    const std::string sentence =
      "The checkpoint '" + path(level) + "' cannot be written";

    on_first_process(communicator, [&]() {
      with_sentence(sentence, [&]() {
        fs::remove_all(part);
        fs::create_directory(part);
      });
      std::ofstream out(part / "record", std::ios::binary);
      out.write(record.data(), record.size());
      out.close();
      if (!out)
        throw InputError(sentence + ": is the disk full?");
    });

    // What is on a cell includes corners that other processes own.
    std::vector<VectorType>         ghosted(vectors.size());
    std::vector<const VectorType *> pointers;
    for (unsigned int i = 0; i < vectors.size(); ++i)
      {
        ghosted[i] = *vectors[i];
        ghosted[i].update_ghost_values();
        pointers.push_back(&ghosted[i]);
      }
    const std::uint64_t size = triangulation.n_global_active_cells() *
      vectors.size() * dof_handler.get_fe().n_dofs_per_cell() * sizeof(double);
    demand_space((part / "mesh").string(), communicator, size);
    try
      {
        Compatibility::SolutionTransfer<dim, VectorType> transfer(dof_handler);
        transfer.prepare_for_serialization(pointers);
        triangulation.save((part / "mesh").string());
      }
    catch (const std::exception &)
      {
        throw_or_abort(communicator, sentence + ": is the disk full?");
      }

    // Not all who write look whether they could.
    on_first_process(communicator, [&]() {
      with_sentence(sentence, [&]() {
        if (fs::file_size(part / "mesh") == 0 ||
            fs::file_size(part / "mesh.info") == 0 ||
            fs::file_size(part / "mesh_fixed.data") < size)
          throw InputError(sentence + " completely: is the disk full?");
      });
    });

    // From here on the first process acts alone. A directory is a file, too;
    // its entries, and then its new name, have to reach the disk as well.
    on_first_process(communicator, [&]() {
      with_sentence(sentence, [&]() {
        for (const auto &entry : fs::directory_iterator(part))
          flush_to_disk(entry.path().string());
        flush_to_disk(part.string());
        fs::remove_all(path(level) + unfinished);
        if (fs::exists(path(level)))
          fs::rename(path(level), path(level) + unfinished);
        fs::rename(part, path(level));
        flush_to_disk(directory.path());
        remove_all_but(path(level));
      });
    });
  }



  unsigned int
  Checkpoints::last_level() const
  {
    int last = -1;
    on_first_process(communicator, [&]() {
      with_sentence(
        "The directory '" + directory.path() + "' cannot be read", [&]() {
          for (const auto &entry : fs::directory_iterator(directory.path()))
            if (const auto level = level_of(entry.path()))
              last = std::max<int>(last, *level);
        });
      if (last < 0)
        throw InputError("There is no checkpoint in '" + directory.path() +
                         "' to restart from; a run writes them with "
                         "'Output/Checkpoint=true'.");
    });
    return Utilities::MPI::broadcast(communicator, last);
  }



  std::vector<char>
  Checkpoints::record(const unsigned int level) const
  {
    std::vector<char> bytes;
    on_first_process(communicator, [&]() {
      std::ifstream in(fs::path(path(level)) / "record", std::ios::binary);
      bytes.assign(std::istreambuf_iterator<char>(in), {});
      if (!in || bytes.empty())
        throw InputError("The checkpoint '" + path(level) +
                         "' cannot be read.");
    });
    return Utilities::MPI::broadcast(communicator, bytes);
  }



  template <int dim>
  void
  Checkpoints::load_mesh(
    const unsigned int                         level,
    parallel::distributed::Triangulation<dim> &triangulation) const
  {
    const fs::path    mesh     = fs::path(path(level)) / "mesh";
    const std::string sentence = "The mesh in the checkpoint '" + path(level) +
      "' cannot be read, or belongs to another coarse mesh.";

    // A missing file would be met in the middle of p4est, which ends the
    // program then.
    on_first_process(communicator, [&]() {
      if (!fs::exists(mesh) || !fs::exists(mesh.string() + ".info"))
        throw InputError(sentence);
    });
    together(
      communicator, sentence, [&]() { triangulation.load(mesh.string()); });
  }



  template <int dim>
  void
  Checkpoints::load_vectors(const DoFHandler<dim>    &dof_handler,
                            std::vector<VectorType *> vectors)
  {
    Compatibility::SolutionTransfer<dim, VectorType> transfer(dof_handler);
    transfer.deserialize(vectors);
  }



  void
  Checkpoints::remove_all() const
  {
    on_first_process(communicator, [&]() {
      with_sentence("Old checkpoints in '" + directory.path() +
                      "' cannot be removed",
                    [&]() { remove_all_but(""); });
    });
  }



  void
  Checkpoints::remove_all_but(const std::string &kept) const
  {
    std::vector<fs::path> old;
    for (const auto &entry : fs::directory_iterator(directory.path()))
      {
        const std::string name = entry.path().filename().string();
        const bool        is_part =
          name.rfind(prefix, 0) == 0 && entry.path().extension() == unfinished;
        if (entry.is_directory() && entry.path() != fs::path(kept) &&
            (is_part || level_of(entry.path())))
          old.push_back(entry.path());
      }
    for (fs::path &directory_name : old)
      {
        if (directory_name.extension() != unfinished)
          {
            const fs::path renamed = directory_name.string() + unfinished;
            fs::remove_all(renamed);
            fs::rename(directory_name, renamed);
            directory_name = renamed;
          }
        fs::remove_all(directory_name);
      }
  }



  template void
  Checkpoints::save(const unsigned int,
                    const std::vector<char> &,
                    const parallel::distributed::Triangulation<2> &,
                    const DoFHandler<2> &,
                    const std::vector<const VectorType *> &) const;
  template void
  Checkpoints::save(const unsigned int,
                    const std::vector<char> &,
                    const parallel::distributed::Triangulation<3> &,
                    const DoFHandler<3> &,
                    const std::vector<const VectorType *> &) const;

  template void
  Checkpoints::load_mesh(const unsigned int,
                         parallel::distributed::Triangulation<2> &) const;
  template void
  Checkpoints::load_mesh(const unsigned int,
                         parallel::distributed::Triangulation<3> &) const;

  template void Checkpoints::load_vectors(const DoFHandler<2> &,
                                          std::vector<VectorType *>);
  template void Checkpoints::load_vectors(const DoFHandler<3> &,
                                          std::vector<VectorType *>);
} // namespace Friction
