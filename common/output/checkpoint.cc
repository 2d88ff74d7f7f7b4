#include <common/compatibility.h>
#include <common/output/checkpoint.h>
#include <common/output/manifest.h>
#include <common/parallel/collective_error.h>

#include <deal.II/distributed/tria.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <type_traits>

namespace Friction
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    const std::string prefix     = "checkpoint";
    const std::string unfinished = ".part";



    // The level of a directory with the name of a checkpoint.
    std::optional<unsigned int>
    level_of(const fs::path &path)
    {
      const std::string name = path.filename().string();
      if (name.rfind(prefix + "-", 0) != 0)
        return {};
      const std::string number = name.substr(prefix.size() + 1);
      if (number.size() < 2 || number.size() > 6 ||
          (number.size() > 2 && number[0] == '0') ||
          number.find_first_not_of("0123456789") != number.npos)
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



    // The length of the file that deal.II writes vectors to, with @p payload
    // bytes of them per cell. It begins with a few numbers: where in the data
    // of a cell the first part ends, the second, and so on, the last one being
    // that of the vectors. Of a file that begins otherwise we expect nothing.
    std::uint64_t
    expected_length(const fs::path     &file,
                    const std::uint64_t n_cells,
                    const std::uint64_t payload)
    {
      std::ifstream in(file, std::ios::binary);
      std::uint32_t end = 0;
      for (unsigned int n = 1;
           n <= 8 && in.read(reinterpret_cast<char *>(&end), sizeof(end));
           ++n)
        if (end >= payload && end <= payload + 64)
          return n * sizeof(end) + n_cells * end;
      return 0;
    }



    // Removes a directory on the way out, if it is still there then: what is
    // half-written would take room on a disk that may be full.
    class UnfinishedDirectory
    {
    public:
      explicit UnfinishedDirectory(const fs::path &path)
        : path(path)
      {}

      UnfinishedDirectory(const UnfinishedDirectory &)            = delete;
      UnfinishedDirectory &operator=(const UnfinishedDirectory &) = delete;

      ~UnfinishedDirectory()
      {
        std::error_code ignored;
        if (!path.empty())
          fs::remove_all(path, ignored);
      }

    private:
      const fs::path path;
    };



    // The mesh of a checkpoint, which make_triangulation() has made for that.
    template <int dim, typename Mesh>
    auto &
    saved_mesh(Mesh &mesh)
    {
      using Distributed = parallel::distributed::Triangulation<dim>;
      auto *const distributed =
        dynamic_cast<std::conditional_t<std::is_const<Mesh>::value,
                                        const Distributed,
                                        Distributed> *>(&mesh);
      AssertThrow(
        distributed != nullptr,
        ExcMessage("Checkpoints need a mesh that make_triangulation() "
                   "has made for checkpoints."));
      return *distributed;
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
  Checkpoints::save(const unsigned int                     level,
                    const std::vector<char>               &record,
                    const DoFHandler<dim>                 &dof_handler,
                    const std::vector<const VectorType *> &vectors) const
  {
    const auto &triangulation =
      saved_mesh<dim>(dof_handler.get_triangulation());
    const fs::path    part = directory.file(prefix + unfinished);
    const std::string sentence =
      "The checkpoint '" + path(level) + "' cannot be written";
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    const UnfinishedDirectory unfinished_directory(first ? part : "");

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
    const std::uint64_t n_cells = triangulation.n_global_active_cells();
    const std::uint64_t payload =
      vectors.size() * dof_handler.get_fe().n_dofs_per_cell() * sizeof(double);
    // Besides vectors there are a few numbers per cell, and what disks round
    // up.
    demand_space((part / "mesh").string(),
                 communicator,
                 n_cells * (payload + 32) + (1 << 15));
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
    const fs::path vectors_file = part / "mesh_fixed.data";
    on_first_process(communicator, [&]() {
      with_sentence(sentence, [&]() {
        if (fs::file_size(part / "mesh") == 0 ||
            fs::file_size(part / "mesh.info") == 0 ||
            fs::file_size(vectors_file) < n_cells * payload ||
            fs::file_size(vectors_file) <
              expected_length(vectors_file, n_cells, payload))
          throw InputError(sentence + " completely: is the disk full?");
      });
    });

    // From here on the first process acts alone. A directory is a file, too;
    // its entries, and then its new name, have to reach the disk as well. What
    // the manifest says is read from the disk, or from where the system keeps
    // what is there.
    on_first_process(communicator, [&]() {
      with_sentence(sentence, [&]() {
        const auto flush_all = [&]() {
          for (const auto &entry : fs::directory_iterator(part))
            flush_to_disk(entry.path().string());
        };
        flush_all();
        Manifest::write(part.string(), level);
        flush_all();
        flush_to_disk(part.string());
        fs::remove_all(path(level) + unfinished);
        if (fs::exists(path(level)))
          fs::rename(path(level), path(level) + unfinished);
        fs::rename(part, path(level));
        flush_to_disk(directory.path());

        // The one before is kept.
        std::vector<unsigned int> old = levels();
        const auto                before =
          std::find_if(old.begin(), old.end(), [&](const unsigned int l) {
            return l < level;
          });
        if (before != old.end())
          old.erase(before);
        old.erase(std::remove(old.begin(), old.end(), level), old.end());
        remove(old);
      });
    });
  }



  Checkpoints::Last
  Checkpoints::find_last() const
  {
    Last last;
    on_first_process(communicator, [&]() {
      std::vector<unsigned int> candidates;
      with_sentence("The directory '" + directory.path() + "' cannot be read",
                    [&]() { candidates = levels(); });
      if (candidates.empty())
        throw InputError("There is no checkpoint in '" + directory.path() +
                         "' to restart from; a run writes them with "
                         "'Output/Checkpoint=true'.");

      std::string faults;
      for (const unsigned int level : candidates)
        {
          const std::string fault = Manifest::fault(path(level), level);
          if (fault.empty())
            {
              last.level = level;
              if (!faults.empty())
                last.warning = "Warning: " + faults +
                  "; the run continues from '" + path(level) + "' instead.";
              return;
            }
          faults += (faults.empty() ? "the checkpoint '" : "; '") +
            path(level) + "' cannot be used: " + fault;
        }
      faults[0] = 'T';
      throw InputError(faults + "; begin anew, without --restart.");
    });
    last.level = Utilities::MPI::broadcast(communicator, last.level);
    return last;
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
  Checkpoints::load_mesh(const unsigned int  level,
                         Triangulation<dim> &triangulation) const
  {
    auto             &distributed_mesh = saved_mesh<dim>(triangulation);
    const fs::path    mesh             = fs::path(path(level)) / "mesh";
    const std::string sentence = "The mesh in the checkpoint '" + path(level) +
      "' cannot be read, or belongs to another coarse mesh.";

    // A missing file would be met in the middle of p4est, which ends the
    // program then.
    on_first_process(communicator, [&]() {
      if (!fs::exists(mesh) || !fs::exists(mesh.string() + ".info"))
        throw InputError(sentence);
    });
    together(
      communicator, sentence, [&]() { distributed_mesh.load(mesh.string()); });
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
                    [&]() { remove(levels()); });
    });
  }



  void
  Checkpoints::remove_after(const unsigned int level) const
  {
    on_first_process(communicator, [&]() {
      with_sentence(
        "Old checkpoints in '" + directory.path() + "' cannot be removed",
        [&]() {
          std::vector<unsigned int> old = levels();
          old.erase(
            std::find_if(old.begin(),
                         old.end(),
                         [&](const unsigned int l) { return l <= level; }),
            old.end());
          remove(old);
        });
    });
  }



  // The last one first.
  std::vector<unsigned int>
  Checkpoints::levels() const
  {
    std::vector<unsigned int> levels;
    for (const auto &entry : fs::directory_iterator(directory.path()))
      if (const auto level = level_of(entry.path()))
        if (entry.is_directory())
          levels.push_back(*level);
    std::sort(levels.rbegin(), levels.rend());
    return levels;
  }



  // What is left of unfinished ones is removed in any case.
  void
  Checkpoints::remove(const std::vector<unsigned int> &old) const
  {
    for (const unsigned int level : old)
      {
        fs::remove_all(path(level) + unfinished);
        fs::rename(path(level), path(level) + unfinished);
      }
    std::vector<fs::path> parts;
    for (const auto &entry : fs::directory_iterator(directory.path()))
      {
        const fs::path stem = entry.path().stem();
        if (entry.path().extension() == unfinished && entry.is_directory() &&
            (stem == prefix || level_of(stem)))
          parts.push_back(entry.path());
      }
    for (const fs::path &part : parts)
      fs::remove_all(part);
  }



  template void
  Checkpoints::save(const unsigned int,
                    const std::vector<char> &,
                    const DoFHandler<2> &,
                    const std::vector<const VectorType *> &) const;
  template void
  Checkpoints::save(const unsigned int,
                    const std::vector<char> &,
                    const DoFHandler<3> &,
                    const std::vector<const VectorType *> &) const;

  template void Checkpoints::load_mesh(const unsigned int,
                                       Triangulation<2> &) const;
  template void Checkpoints::load_mesh(const unsigned int,
                                       Triangulation<3> &) const;

  template void Checkpoints::load_vectors(const DoFHandler<2> &,
                                          std::vector<VectorType *>);
  template void Checkpoints::load_vectors(const DoFHandler<3> &,
                                          std::vector<VectorType *>);
} // namespace Friction
