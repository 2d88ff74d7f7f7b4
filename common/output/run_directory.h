#ifndef friction_output_run_directory_h
#define friction_output_run_directory_h

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>

namespace Friction
{
  /**
   * Writes a file beside its final place and renames it when it is complete.
   * Renaming within a directory is atomic: a program that opens the final
   * name finds the previous file or the new one, never half of either, also if
   * the run is killed in between or the disk is full.
   *
   * @p write_to gets the temporary name, in the same directory as
   * @p final_name and with the same ending. If it throws, or if the file cannot
   * be renamed, the temporary file is removed and the exception passed on.
   * Before the file gets its name, its contents are on the disk.
   */
  void write_then_rename(
    const std::string                                            &final_name,
    const std::function<void(const std::string &temporary_name)> &write_to);

  /**
   * The same for everything that is written into a stream. Write errors,
   * a full disk above all, become one InputError that names the file; a writer
   * need not check its stream.
   */
  void
  write_stream_then_rename(const std::string &final_name,
                           const std::function<void(std::ostream &)> &write_to);

  /**
   * Throws an InputError on all processes if a file of @p size bytes cannot be
   * written, since there is no room or a quota. Collective.
   *
   * @param file_name  what the sentence names. That much room is taken for a
   *                   moment under the name of the temporary file that
   *                   write_then_rename() writes, so that a program which is
   *                   killed meanwhile leaves nothing under the final name.
   */
  void demand_space(const std::string  &file_name,
                    const MPI_Comm      communicator,
                    const std::uint64_t size);

  /**
   * The same for one file that all processes write together: @p write_to is
   * called by all of them with the same temporary name, the first one renames.
   * That the disk is full is asked for before, and is an InputError on all of
   * them. What cannot be known before is found out in the middle of collective
   * operations and ends all processes.
   *
   * @param size  in bytes, about, of the whole file.
   */
  void write_together_then_rename(
    const std::string                                            &final_name,
    const MPI_Comm                                                communicator,
    const std::uint64_t                                           size,
    const std::function<void(const std::string &temporary_name)> &write_to);

  /// Wait until a file, or a directory, is on the disk. Throws InputError.
  void flush_to_disk(const std::string &path);

  /**
   * The directory a run writes into. An object of this class is the proof that
   * the directory exists and can be written to, so a run learns this in its
   * first second and not after its last level.
   */
  class RunDirectory
  {
  public:
    /**
     * Create the directory and its parents where they are missing. Throws an
     * InputError of one sentence if this is impossible, or if no file can be
     * written there. With several processes, the first one creates it and all
     * try, for they may run on different machines; an error of one is that of
     * all.
     */
    explicit RunDirectory(const std::string &path,
                          const MPI_Comm     communicator = MPI_COMM_SELF);

    /// The path as it was given.
    const std::string &path() const;

    /// The path of a file in this directory.
    std::string file(const std::string &name) const;

    /// write_stream_then_rename() for a file in this directory.
    void write(const std::string                         &name,
               const std::function<void(std::ostream &)> &write_to) const;

    /// Removes a file of this directory, if it is there. Throws an InputError
    /// that names it if that is impossible: it may be a directory.
    void remove(const std::string &name) const;

  private:
    void create() const;

    void try_to_write(const unsigned int rank) const;

    std::string directory;
  };
} // namespace Friction

#endif
