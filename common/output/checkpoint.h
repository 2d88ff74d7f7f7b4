#ifndef friction_output_checkpoint_h
#define friction_output_checkpoint_h

#include <deal.II/base/mpi.h>

#include <deal.II/grid/tria.h>

#include <deal.II/dofs/dof_handler.h>

#include <common/output/run_directory.h>
#include <common/parallel/vector_type.h>

#include <string>
#include <vector>

namespace Friction
{
  /**
   * The checkpoints of a run, each a directory `checkpoint-NN` in that of the
   * run. It holds what is needed to solve level NN and to go on from there:
   * - `mesh` and the files beside it that deal.II makes: the mesh of that
   *   level, and the vectors that were interpolated to it, or that a load
   *   step begins with;
   * - `record`: whatever else the run wants to remember, as a sequence of
   *   bytes;
   * - `manifest`: what the others have to be like, see Manifest.
   *
   * A checkpoint is complete or absent. It is written as `checkpoint.part`, and
   * gets its name when all of it is on the disk. Only then its predecessors are
   * removed, and they lose their names before they lose any of their files. A
   * run that is killed may leave directories with `.part` in their names; they
   * are never read, and the next checkpoint removes them.
   *
   * Disks err, and files get lost when they are moved. So the last two
   * checkpoints are kept, and before anything of one is read, all of it is
   * compared with its manifest. If the last one is damaged, the one before
   * takes its place, which costs the solution of one level.
   *
   * Vectors are stored cell by cell, and p4est cuts the mesh anew when it is
   * read. Therefore the number of processes may be another one then.
   *
   * All functions are collective operations, and an error of one process is
   * that of all.
   */
  class Checkpoints
  {
  public:
    Checkpoints(const RunDirectory &directory, const MPI_Comm communicator);

    /// From where a run can go on.
    struct Last
    {
      unsigned int level = 0;

      /// A sentence if it is not the last one that was written, or nothing.
      std::string warning;
    };

    /**
     * Write a checkpoint, and remove all others but the one before.
     *
     * @param level    the level that is to be solved next.
     * @param record   that of the first process is written.
     * @param dof_handler, vectors  on the mesh of that level, which
     *   make_triangulation() has made for checkpoints.
     */
    template <int dim>
    void save(const unsigned int                     level,
              const std::vector<char>               &record,
              const dealii::DoFHandler<dim>         &dof_handler,
              const std::vector<const VectorType *> &vectors) const;

    /**
     * The last checkpoint that is as it was written. Throws an InputError if
     * there is none, which says what is wrong with those that there are.
     */
    Last find_last() const;

    /// The record of a checkpoint, on all processes.
    std::vector<char> record(const unsigned int level) const;

    /**
     * Refine a coarse mesh, which must be the one that the mesh was made from,
     * and which make_triangulation() has made for checkpoints.
     */
    template <int dim>
    void load_mesh(const unsigned int          level,
                   dealii::Triangulation<dim> &triangulation) const;

    /**
     * Read the vectors, as many as were saved. To be called once after
     * load_mesh(), when degrees of freedom have been distributed and the
     * vectors have been given their sizes. They have no ghost values then.
     */
    template <int dim>
    static void load_vectors(const dealii::DoFHandler<dim> &dof_handler,
                             std::vector<VectorType *>      vectors);

    /// Remove all checkpoints, and what is left of unfinished ones.
    void remove_all() const;

    /// The same for those of levels after a given one.
    void remove_after(const unsigned int level) const;

  private:
    std::string path(const unsigned int level) const;

    /// These are to be called by the first process only.
    std::vector<unsigned int> levels() const;
    void remove(const std::vector<unsigned int> &old) const;

    const RunDirectory directory;
    const MPI_Comm     communicator;
  };
} // namespace Friction

#endif
