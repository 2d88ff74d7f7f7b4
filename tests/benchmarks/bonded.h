#ifndef friction_tests_benchmarks_bonded_h
#define friction_tests_benchmarks_bonded_h

#include <common/contact/contact_state.h>
#include <common/discretization/discrete_problem.h>

namespace Benchmark
{
  using namespace Friction;

  // Makes the displacements of all nodes in contact prescribed ones.
  template <int dim>
  NodalConstraints<dim>
  bond(const DiscreteProblem<dim> &problem,
       const VectorType           &u,
       const ContactState         &state)
  {
    NodalConstraints<dim> bonded = problem.constraints;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      if (state.in_contact(p))
        for (unsigned int d = 0; d < dim; ++d)
          bonded.prescribe(problem.contact[p].node,
                           d,
                           u.local_element(dim * problem.contact[p].node + d));
    bonded.update_ghosts();
    return bonded;
  }
} // namespace Benchmark

#endif
