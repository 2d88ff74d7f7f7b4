#ifndef friction_algorithms_load_steps_h
#define friction_algorithms_load_steps_h

#include <common/algorithms/force_control.h>
#include <common/discretization/discretization.h>
#include <common/scene/scene.h>

#include <vector>

namespace Friction
{
  /**
   * Goes from one load step of a scene to the next. What a step leaves to the
   * one after it is its mesh, its displacement, from which friction counts slip
   * from then on, and a good guess.
   */
  template <int dim>
  class LoadSteps
  {
  public:
    /**
     * To be called when a step is solved and is not the last one: sets the time
     * of the scene, and the discretisation up anew on its mesh; assemble() has
     * to follow.
     *
     * On call the vectors are displacement and contact tractions of the step
     * that has ended, on return guesses for the next one: what has been found
     * plus a multiple of the last change on this mesh. The multiple is the next
     * change of prescribed displacements relative to their last one or, if they
     * did not change, the ratio of the two time steps; it is negative where
     * loads are taken back. After the first step there is no change to repeat,
     * and one that would have to be repeated more than four times is not.
     * Platens are moved to where the forces of the next
     * step are expected. Collective.
     */
    void begin_next(Scene<dim>          &scene,
                    Discretization<dim> &discretization,
                    ForceControl<dim>   &force_control,
                    VectorType          &displacement,
                    VectorType          &tractions);

    /**
     * What a checkpoint has to hold: the guess, and in later load steps
     * displacement, contact tractions and prescribed displacements of the step
     * before. A run that is continued reads into these vectors, and calls
     * resume() then.
     * @param discretization  of the load step, which gives vectors of the step
     *                        before their sizes, if they are empty.
     */
    std::vector<VectorType *>
    checkpoint_vectors(const Discretization<dim> &discretization,
                       VectorType                &displacement,
                       VectorType                &tractions);

    /** Takes the place of begin_next() in a run that is continued with the
     * present load step of the scene: has friction count slip from the
     * displacement of the step before. Collective. */
    void resume(Discretization<dim> &discretization);

  private:
    // Of the step that has ended last; empty in the first one.
    VectorType last_displacement, last_tractions, last_prescribed;

    double growth(const VectorType &prescribed,
                  const VectorType &next_prescribed,
                  const double      time_ratio,
                  const MPI_Comm    communicator) const;
  };
} // namespace Friction

#endif
