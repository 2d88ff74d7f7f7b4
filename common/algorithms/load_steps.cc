#include <common/algorithms/load_steps.h>
#include <common/parallel/reductions.h>

#include <array>
#include <cmath>

namespace Friction
{
  // A change that is repeated more often than this is no guess: what rounding
  // and the solver's tolerance have added to it is repeated as well, and zones
  // of contact do not go on like that.
  constexpr double largest_growth = 4.;



  template <int dim>
  void
  LoadSteps<dim>::begin_next(Scene<dim>          &scene,
                             Discretization<dim> &discretization,
                             ForceControl<dim>   &force_control,
                             VectorType          &displacement,
                             VectorType          &tractions)
  {
    const unsigned int step             = scene.load_step();
    const VectorType   old_displacement = displacement;
    const VectorType   old_tractions    = tractions;
    const VectorType   old_prescribed =
      discretization.constraints().prescribed_values();
    scene.begin_load_step(step + 1);
    force_control.predict();
    discretization.set_up();
    discretization.set_slip_origin(old_displacement);

    double factor = 0.;
    if (last_displacement.size() > 0)
      {
        AssertDimension(last_displacement.size(), old_displacement.size());
        factor = growth(old_prescribed,
                        discretization.constraints().prescribed_values(),
                        (scene.time(step + 1) - scene.time(step)) /
                          (scene.time(step) - scene.time(step - 1)),
                        discretization.constraints().communicator());
        if (!(std::abs(factor) <= largest_growth))
          factor = 0.;
      }
    const auto go_on =
      [&](VectorType &v, const VectorType &now, VectorType &last) {
        v = discretization.vector();
        v.copy_locally_owned_data_from(now);
        if (factor != 0.)
          for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
            v.local_element(i) +=
              factor * (now.local_element(i) - last.local_element(i));
        last = now;
      };
    go_on(displacement, old_displacement, last_displacement);
    go_on(tractions, old_tractions, last_tractions);
    last_prescribed = old_prescribed;
  }



  template <int dim>
  std::vector<VectorType *>
  LoadSteps<dim>::checkpoint_vectors(const Discretization<dim> &discretization,
                                     VectorType                &displacement,
                                     VectorType                &tractions)
  {
    std::vector<VectorType *> vectors = {&displacement, &tractions};
    if (discretization.scene().load_step() > 0)
      for (VectorType *v :
           {&last_displacement, &last_tractions, &last_prescribed})
        {
          if (v->size() == 0)
            *v = discretization.vector();
          vectors.push_back(v);
        }
    return vectors;
  }



  template <int dim>
  void
  LoadSteps<dim>::resume(Discretization<dim> &discretization)
  {
    if (discretization.scene().load_step() > 0)
      discretization.set_slip_origin(last_displacement);
  }



  // The multiple of the last change of prescribed values that comes closest to
  // the next one.
  template <int dim>
  double
  LoadSteps<dim>::growth(const VectorType &prescribed,
                         const VectorType &next_prescribed,
                         const double      time_ratio,
                         const MPI_Comm    communicator) const
  {
    double product = 0, square = 0;
    for (unsigned int i = 0; i < prescribed.locally_owned_size(); ++i)
      {
        const double last =
          prescribed.local_element(i) - last_prescribed.local_element(i);
        product += last *
          (next_prescribed.local_element(i) - prescribed.local_element(i));
        square += last * last;
      }
    const auto sums = sum_over_processes(
      std::array<double, 2>{{product, square}}, communicator);
    return sums[1] > 0 ? sums[0] / sums[1] : time_ratio;
  }



  template class LoadSteps<2>;
  template class LoadSteps<3>;
} // namespace Friction
