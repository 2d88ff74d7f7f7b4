#include <common/algorithms/phase_path.h>
#include <common/algorithms/pivoting_solver.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Friction
{
  namespace
  {
    // A direction in which a node is free.
    struct Direction
    {
      unsigned int node;
      NodeValue<2> vector;
    };

    double
    component(const Direction &k, const VectorType &v)
    {
      return dot<2>(k.vector.data(), v.begin() + 2 * k.node);
    }



    // The problem in these directions, and its nodes.
    struct DenseProblem
    {
      std::vector<Direction>       directions;
      std::vector<PhasePath::Node> nodes;
      std::vector<double>          matrix, load, displacement, force;

      DenseProblem(const DiscreteProblem<2> &problem,
                   const VectorType         &u,
                   const ContactState       &state)
      {
        find_directions(problem, state);
        find_matrix(problem.stiffness.blocks());

        // Prescribed displacements are a part of the load.
        VectorType residual(u);
        problem.stiffness.residual(residual, problem.forces, u);
        const std::size_t n = directions.size();
        for (const Direction &k : directions)
          {
            displacement.push_back(component(k, u));
            force.push_back(component(k, residual));
          }
        load = force;
        for (std::size_t k = 0; k < n; ++k)
          for (std::size_t i = 0; i < n; ++i)
            load[i] += matrix[k * n + i] * displacement[k];
        for (unsigned int p = 0; p < nodes.size(); ++p)
          if (problem.has_coulomb_friction(problem.contact[p]))
            force[nodes[p].normal] = state.normal_force(p);
      }

    private:
      void
      find_directions(const DiscreteProblem<2> &problem,
                      const ContactState       &state)
      {
        const NodeBlockMatrix<2> &A = problem.stiffness.blocks();
        std::vector<char>         is_contact(A.n_rows(), false);
        for (unsigned int p = 0; p < problem.contact.size(); ++p)
          {
            const ContactNode<2> &at = problem.contact[p];
            is_contact[at.node]      = true;
            PhasePath::Node node;
            node.normal     = add(at.node, at.frame[0]);
            node.tangential = at.n_free_tangents > 0 ? add(at.node, at.frame[1])
                                                     : PhasePath::nowhere;
            node.gap        = at.gap;
            node.slip_origin        = at.slip_origin * at.frame[1];
            const double F          = problem.effective_coefficient(at);
            const bool   is_coulomb = problem.has_coulomb_friction(at);
            node.coefficient        = is_coulomb ? F : 0.;
            node.bound = is_coulomb ? 0. : F * state.normal_force(p);
            nodes.push_back(node);
          }
        for (unsigned int i = 0; i < A.n_rows(); ++i)
          for (unsigned int d = 0; d < 2 && !is_contact[i]; ++d)
            if (!A.is_empty(i) && !problem.constraints.is_prescribed(i, d))
              add(i, Point<2>::unit_vector(d));
      }

      unsigned int
      add(const unsigned int node, const Tensor<1, 2> &vector)
      {
        directions.push_back({node, {{vector[0], vector[1]}}});
        return directions.size() - 1;
      }

      void
      find_matrix(const NodeBlockMatrix<2> &A)
      {
        const std::size_t                      n = directions.size();
        std::vector<std::vector<unsigned int>> of_node(A.n_rows());
        for (unsigned int k = 0; k < n; ++k)
          of_node[directions[k].node].push_back(k);
        matrix.assign(n * n, 0.);
        for (std::size_t k = 0; k < n; ++k)
          {
            const unsigned int i = directions[k].node;
            for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
              for (const unsigned int l : of_node[A.column(e)])
                {
                  const NodeValue<2> image =
                    times<2>(A.value(i, e).data(), directions[l].vector.data());
                  matrix[l * n + k] =
                    dot<2>(directions[k].vector.data(), image.data());
                }
          }
      }
    };
  } // namespace



  SolverReport
  solve_by_pivoting(NewtonSolver<2>       &newton,
                    VectorType            &u,
                    ContactState          &state,
                    const CoulombSettings &limits,
                    const Progress        &progress)
  {
    const DiscreteProblem<2> &problem =
      newton.tresca_functional().discrete_problem();
    DenseProblem dense(problem, u, state);
    PhasePath    path(std::move(dense.matrix), dense.load, dense.nodes);

    // Iterations that Newton's method would have done meanwhile; a tiny problem
    // takes it some time, too.
    const double       n        = dense.directions.size();
    const double       per_step = std::max(1e4, n * n * n / 3);
    const auto        &budget   = limits.limits.budget;
    const unsigned int most_steps =
      std::min(limits.limits.maximum_cycles,
               budget ? budget->cycles_left() : limits.limits.maximum_cycles);
    std::vector<char> touches;
    for (unsigned int p = 0; p < state.size(); ++p)
      touches.push_back(state.in_contact(p));
    path.begin(touches, dense.displacement, dense.force);
    const bool         has_arrived = path.follow(most_steps * per_step);
    const unsigned int n_steps = std::ceil(path.n_multiplications() / per_step);
    for (unsigned int i = 0; i < n_steps && budget; ++i)
      budget->take_cycle();

    if (has_arrived)
      {
        const std::vector<double> found = path.displacement(),
                                  force = path.force();
        for (unsigned int k = 0; k < dense.directions.size(); ++k)
          for (unsigned int d = 0; d < 2; ++d)
            u.local_element(2 * dense.directions[k].node + d) +=
              dense.directions[k].vector[d] *
              (found[k] - dense.displacement[k]);
        for (unsigned int p = 0; p < state.size(); ++p)
          {
            const PhasePath::Phase &phase = path.phases()[p];
            state.set(p, phase.in_contact, phase.sticks);
            if (problem.has_coulomb_friction(problem.contact[p]))
              state.set_normal_force(p, force[dense.nodes[p].normal]);
          }
      }

    SolverReport report;
    if (has_arrived)
      report = solve_by_newton(newton, u, state, limits, progress);
    else
      certify(report, newton.tresca_functional(), u, state);
    CycleInfo on_the_way =
      report.cycles.empty() ? CycleInfo() : report.cycles.front();
    on_the_way.increment = 1;
    report.cycles.insert(report.cycles.begin(), n_steps, on_the_way);
    report.solver_memory += path.memory_consumption();
    return report;
  }
} // namespace Friction
