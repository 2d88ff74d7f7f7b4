#include <Eigen/Sparse>
#include <tests/reference/solutions/both_dimensions.h>
#include <tests/reference/solutions/dense_contact.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace Reference
{
  Eigen::SparseMatrix<double>
  stiffness(const Mesh &mesh, const double nu)
  {
    const double lambda = nu / ((1. + nu) * (1. - 2. * nu));
    const double mu     = 1. / (2. * (1. + nu));

    Eigen::Matrix3d material;
    material << lambda + 2. * mu, lambda, 0., //
      lambda, lambda + 2. * mu, 0.,           //
      0., 0., mu;

    const double                        q = 1. / std::sqrt(3.);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(64 * mesh.cells.size());

    for (const auto &cell : mesh.cells)
      {
        Eigen::Matrix<double, 8, 8> cell_matrix;
        cell_matrix.setZero();
        for (const double xi : {-q, q})
          for (const double eta : {-q, q})
            {
              Eigen::Matrix<double, 4, 2> reference_gradients;
              reference_gradients << -(1. - eta), -(1. - xi), //
                (1. - eta), -(1. + xi),                       //
                -(1. + eta), (1. - xi),                       //
                (1. + eta), (1. + xi);
              reference_gradients *= 0.25;

              Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
              for (unsigned int v = 0; v < 4; ++v)
                jacobian += mesh.nodes[cell[v]] * reference_gradients.row(v);
              const double det = jacobian.determinant();
              if (det <= 0.)
                throw std::runtime_error(
                  "Reference: a cell is degenerate or its vertices are not "
                  "in lexicographic order.");
              const Eigen::Matrix<double, 4, 2> gradients =
                reference_gradients * jacobian.inverse();

              Eigen::Matrix<double, 3, 8> strain;
              for (unsigned int v = 0; v < 4; ++v)
                strain.middleCols<2>(2 * v) << gradients(v, 0), 0., //
                  0., gradients(v, 1),                              //
                  gradients(v, 1), gradients(v, 0);
              cell_matrix += det * strain.transpose() * material * strain;
            }
        for (unsigned int i = 0; i < 8; ++i)
          for (unsigned int j = 0; j < 8; ++j)
            entries.emplace_back(2 * cell[i / 2] + i % 2,
                                 2 * cell[j / 2] + j % 2,
                                 cell_matrix(i, j));
      }

    Eigen::SparseMatrix<double> matrix(2 * mesh.nodes.size(),
                                       2 * mesh.nodes.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }



  namespace
  {
    /// The positive tangent that belongs to a normal.
    Eigen::Vector2d
    tangent(const Eigen::Vector2d &normal)
    {
      return {-normal[1], normal[0]};
    }


    /**
     * The affine map u = basis * x + offset from the free degrees of freedom to
     * all, that satisfies Dirichlet conditions and hanging-node constraints.
     */
    struct FreeSpace
    {
      explicit FreeSpace(const ContactProblem &problem)
      {
        const unsigned int n_dofs = 2 * problem.mesh.nodes.size();
        std::vector<bool>  fixed(n_dofs, false), hangs(n_dofs, false);
        offset = Eigen::VectorXd::Zero(n_dofs);
        for (const auto &d : problem.dirichlet)
          {
            fixed[2 * d.node + d.component]  = true;
            offset[2 * d.node + d.component] = d.value;
          }
        for (const auto &h : problem.hanging)
          for (unsigned int c = 0; c < 2; ++c)
            {
              hangs[2 * h.node + c] = true;
              if (fixed[2 * h.node + c])
                throw std::runtime_error(
                  "Reference: a hanging node has a prescribed displacement.");
            }

        index.assign(n_dofs, -1);
        unsigned int n_free = 0;
        for (unsigned int i = 0; i < n_dofs; ++i)
          if (!fixed[i] && !hangs[i])
            index[i] = n_free++;

        std::vector<Eigen::Triplet<double>> entries;
        for (unsigned int i = 0; i < n_dofs; ++i)
          if (index[i] >= 0)
            entries.emplace_back(i, index[i], 1.);
        for (const auto &h : problem.hanging)
          for (const auto &[master, weight] : h.masters)
            for (unsigned int c = 0; c < 2; ++c)
              {
                const unsigned int i = 2 * h.node + c, j = 2 * master + c;
                if (hangs[j])
                  throw std::runtime_error(
                    "Reference: a master of a hanging node hangs itself.");
                if (fixed[j])
                  offset[i] += weight * offset[j];
                else
                  entries.emplace_back(i, index[j], weight);
              }
        basis.resize(n_dofs, n_free);
        basis.setFromTriplets(entries.begin(), entries.end());

        // Forces at hanging nodes act through their masters, prescribed ones
        // included.
        std::vector<Eigen::Triplet<double>> identity;
        for (unsigned int i = 0; i < n_dofs; ++i)
          if (!hangs[i])
            identity.emplace_back(i, i, 1.);
        for (const auto &h : problem.hanging)
          for (const auto &[master, weight] : h.masters)
            for (unsigned int c = 0; c < 2; ++c)
              identity.emplace_back(2 * h.node + c, 2 * master + c, weight);
        distribute.resize(n_dofs, n_dofs);
        distribute.setFromTriplets(identity.begin(), identity.end());
      }

      std::vector<int>            index; ///< free number of a dof, or -1
      Eigen::SparseMatrix<double> basis;
      Eigen::SparseMatrix<double> distribute;
      Eigen::VectorXd             offset;
    };


    /**
     * Where one contact node stands: four linear equations cover all cases in
     * two dimensions, which makes the problem a finite search.
     */
    struct Phase
    {
      enum Tangential
      {
        left  = -1, ///< slides against t
        stick = 0,
        right = 1, ///< slides along t
        free  = 2  ///< no friction acts
      };

      bool       touches    = true;
      Tangential tangential = stick;

      bool
      operator<(const Phase &other) const
      {
        return std::make_pair(touches, int(tangential)) <
          std::make_pair(other.touches, int(other.tangential));
      }
    };


    /**
     * The problem condensed to the contact nodes. In the frames (n,t):
     * R = K v - b, and the law of the header between v and R.
     */
    struct CondensedProblem
    {
      Eigen::MatrixXd          K;
      Eigen::VectorXd          b;
      Friction                 law;
      std::vector<ContactNode> nodes;
      double                   force_scale = 1.;

      /**
       * Linear rows of a node with given phase, from its rows `row_n`, `row_t`
       * of K and `b`: left-hand sides are coefficients of v, unit rows being
       * scaled by the diagonal.
       */
      template <typename Row>
      void
      equations(const Phase       &phase,
                const ContactNode &node,
                const unsigned int i, // column of the node's normal component
                const Row         &row_n,
                const Row         &row_t,
                const double       b_n,
                const double       b_t,
                Row               &left_n,
                Row               &left_t,
                double            &right_n,
                double            &right_t) const
      {
        if (phase.touches)
          {
            left_n.setZero();
            left_n[i] = row_n[i];
            right_n   = row_n[i] * node.gap;
          }
        else
          {
            left_n  = row_n;
            right_n = b_n;
          }

        if (phase.tangential == Phase::stick)
          {
            left_t.setZero();
            left_t[i + 1] = row_t[i + 1];
            right_t       = 0.;
          }
        else
          {
            left_t  = row_t;
            right_t = b_t;
            if (phase.tangential != Phase::free)
              {
                const double sign = int(phase.tangential);
                if (law == Friction::tresca)
                  right_t -= sign * node.friction_bound; // R_T = -sign s
                else
                  {
                    // R_T = -sign F tau = sign F R_n
                    const double factor = sign * node.friction_coefficient;
                    left_t -= factor * row_n;
                    right_t -= factor * b_n;
                  }
              }
          }
      }

      /// Friction bound s for given normal force.
      double
      bound(const ContactNode &node, const double tau) const
      {
        switch (law)
          {
            case Friction::tresca:
              return node.friction_bound;
            case Friction::coulomb:
              return node.friction_coefficient * std::max(tau, 0.);
            default:
              return 0.;
          }
      }

      /// The law of one node, its violation in units of force.
      double
      violation(const ContactNode &node,
                const double       k_n,
                const double       k_t,
                const double       v_n,
                const double       v_t,
                const double       R_n,
                const double       R_t) const
      {
        const double distance = k_n * (node.gap - v_n);
        const double s        = bound(node, -R_n);
        double       friction = std::abs(R_t) - s;
        if (s > 0.)
          friction =
            std::abs(-R_t - std::min(std::max(-R_t + k_t * v_t, -s), s));
        return std::max(std::abs(std::min(-R_n, distance)), friction);
      }

      /**
       * The phase that a pair (v,R) asks for: the projections of Alart and
       * Curnier (1991). Ties to rounding keep the previous phase.
       */
      Phase
      predicted_phase(const ContactNode &node,
                      const Phase       &previous,
                      const double       k_n,
                      const double       k_t,
                      const double       v_n,
                      const double       v_t,
                      const double       R_n,
                      const double       R_t) const
      {
        const double noise = 1e-13 * force_scale;
        Phase        phase;
        const double tau = -R_n + k_n * (v_n - node.gap);
        phase.touches    = std::abs(tau) <= noise ? previous.touches : tau > 0.;

        const bool has_friction = law == Friction::tresca
          ? node.friction_bound > 0.
          : law == Friction::coulomb && phase.touches &&
            node.friction_coefficient > 0.;
        if (!has_friction)
          {
            phase.tangential = Phase::free;
            return phase;
          }
        const double s = bound(node, tau), z = -R_t + k_t * v_t;
        if (std::abs(std::abs(z) - s) <= noise &&
            previous.tangential != Phase::free)
          phase.tangential = previous.tangential;
        else if (std::abs(z) <= s)
          phase.tangential = Phase::stick;
        else
          phase.tangential = z > 0. ? Phase::right : Phase::left;
        return phase;
      }

      std::vector<Phase>
      predicted_phases(const std::vector<Phase> &previous,
                       const Eigen::VectorXd    &v) const
      {
        const Eigen::VectorXd R = K * v - b;
        std::vector<Phase>    result;
        for (unsigned int p = 0; p < nodes.size(); ++p)
          result.push_back(predicted_phase(nodes[p],
                                           previous[p],
                                           K(2 * p, 2 * p),
                                           K(2 * p + 1, 2 * p + 1),
                                           v[2 * p],
                                           v[2 * p + 1],
                                           R[2 * p],
                                           R[2 * p + 1]));
        return result;
      }

      Eigen::VectorXd
      solve_linear(const std::vector<Phase> &phases) const
      {
        Eigen::MatrixXd left(K.rows(), K.cols());
        Eigen::VectorXd right(K.rows());
        for (unsigned int p = 0; p < nodes.size(); ++p)
          {
            const unsigned int       i     = 2 * p;
            const Eigen::RowVectorXd row_n = K.row(i), row_t = K.row(i + 1);
            Eigen::RowVectorXd       left_n, left_t;
            left_n.setZero(K.cols());
            left_t.setZero(K.cols());
            equations(phases[p],
                      nodes[p],
                      i,
                      row_n,
                      row_t,
                      b[i],
                      b[i + 1],
                      left_n,
                      left_t,
                      right[i],
                      right[i + 1]);
            left.row(i)     = left_n;
            left.row(i + 1) = left_t;
          }
        const Eigen::PartialPivLU<Eigen::MatrixXd> lu(left);
        Eigen::VectorXd                            v = lu.solve(right);
        v += lu.solve(right - left * v);
        return v;
      }

      /**
       * Semismooth Newton: solve the linear problem of the phases, predict
       * them anew, until they repeat. With all phases linear a repetition is
       * an exact solution. Returns false if they cycle or will not settle.
       */
      bool
      active_set(std::vector<Phase> &phases,
                 Eigen::VectorXd    &v,
                 unsigned int       &steps) const
      {
        std::set<std::vector<Phase>> visited;
        for (steps = 1; steps <= 200; ++steps)
          {
            visited.insert(phases);
            v = solve_linear(phases);
            if (!v.allFinite())
              return false;
            std::vector<Phase> next = predicted_phases(phases, v);
            if (!(next < phases) && !(phases < next))
              return true;
            phases = std::move(next);
            if (visited.count(phases) > 0)
              return false;
          }
        return false;
      }

      /**
       * The fallback: nonlinear block Gauss-Seidel, at each node the law being
       * solved by trying all phases.
       */
      void
      relax(std::vector<Phase> &phases, Eigen::VectorXd &v) const
      {
        using Row = Eigen::RowVector2d;
        for (unsigned int p = 0; p < nodes.size(); ++p)
          v.segment<2>(2 * p) << nodes[p].gap, 0.;

        for (unsigned int sweep = 0; sweep < 200000; ++sweep)
          {
            double change = 0.;
            for (unsigned int p = 0; p < nodes.size(); ++p)
              {
                const unsigned int    i     = 2 * p;
                const Eigen::Matrix2d block = K.block<2, 2>(i, i);
                const Eigen::Vector2d old   = v.segment<2>(i);
                const Eigen::Vector2d c =
                  b.segment<2>(i) - K.middleRows<2>(i) * v + block * old;

                double          best   = std::numeric_limits<double>::max();
                Eigen::Vector2d best_v = old;
                for (const bool touches : {true, false})
                  for (const auto tangential :
                       {Phase::stick, Phase::right, Phase::left, Phase::free})
                    {
                      Phase phase;
                      phase.touches    = touches;
                      phase.tangential = tangential;
                      Row             left_n, left_t;
                      Eigen::Vector2d right;
                      equations<Row>(phase,
                                     nodes[p],
                                     0,
                                     block.row(0),
                                     block.row(1),
                                     c[0],
                                     c[1],
                                     left_n,
                                     left_t,
                                     right[0],
                                     right[1]);
                      Eigen::Matrix2d left;
                      left << left_n, left_t;
                      if (std::abs(left.determinant()) <
                          1e-14 * block.squaredNorm())
                        continue;
                      const Eigen::Vector2d w     = left.inverse() * right;
                      const Eigen::Vector2d R     = block * w - c;
                      const double          error = violation(nodes[p],
                                                     block(0, 0),
                                                     block(1, 1),
                                                     w[0],
                                                     w[1],
                                                     R[0],
                                                     R[1]);
                      if (error < best - 1e-15 * force_scale)
                        {
                          best      = error;
                          best_v    = w;
                          phases[p] = phase;
                        }
                    }
                v.segment<2>(i) = best_v;
                change = std::max(change, (best_v - old).cwiseAbs().maxCoeff());
              }
            if (change <= 1e-15 * v.cwiseAbs().maxCoeff())
              return;
          }
      }
    };
  } // namespace



  Violations
  check(const ContactProblem &problem, const Eigen::VectorXd &u)
  {
    const FreeSpace space(problem);
    const double    E = problem.youngs_modulus;
    Eigen::VectorXd R = stiffness(problem.mesh, problem.poisson_ratio) * u;
    if (problem.forces.size() > 0)
      R -= problem.forces / E;
    R = (space.distribute.transpose() * R).eval();

    const Scales scales(problem, u, R);
    const double force = scales.force, length = scales.length;

    Violations        v;
    std::vector<bool> may_touch(problem.mesh.nodes.size(), false);
    for (const auto &node : problem.contact)
      {
        may_touch[node.node] = true;
        // A wholly prescribed node has nothing left to decide.
        if (space.index[2 * node.node] < 0 &&
            space.index[2 * node.node + 1] < 0)
          continue;
        const Eigen::Vector2d t   = tangent(node.normal);
        const Eigen::Vector2d u_p = u.segment<2>(2 * node.node),
                              R_p = R.segment<2>(2 * node.node);
        const double distance     = (node.gap - u_p.dot(node.normal)) / length;
        const double tau          = -R_p.dot(node.normal) / force;
        const double u_t = u_p.dot(t) / length, R_t = R_p.dot(t) / force;
        double       s = 0.;
        if (problem.friction == Friction::coulomb)
          s = node.friction_coefficient * std::max(tau, 0.);
        else if (problem.friction == Friction::tresca)
          s = node.friction_bound / (E * force);

        v.penetration = std::max(v.penetration, -distance);
        v.tension     = std::max(v.tension, -tau);
        v.complementarity =
          std::max(v.complementarity, std::min(tau, distance));
        v.cone = std::max(v.cone, std::abs(R_t) - s);
        v.slip = std::max(
          {v.slip,
           std::min(s - std::abs(R_t), std::abs(u_t)),
           // opposed to the force wherever it slips
           std::min(std::abs(R_t + std::copysign(s, u_t)), std::abs(u_t))});
      }
    for (unsigned int i = 0; i < space.index.size(); ++i)
      if (space.index[i] >= 0 && !may_touch[i / 2])
        v.equilibrium = std::max(v.equilibrium, std::abs(R[i]) / force);

    // Fields that miss the constraints are no candidates at all.
    const Eigen::VectorXd constrained = space.distribute * u;
    v.equilibrium =
      std::max(v.equilibrium, (u - constrained).cwiseAbs().maxCoeff() / length);
    for (const auto &d : problem.dirichlet)
      v.equilibrium =
        std::max(v.equilibrium,
                 std::abs(u[2 * d.node + d.component] - d.value) / length);
    return v;
  }



  ContactSolution
  solve(const ContactProblem &problem, const Method method)
  {
    const FreeSpace    space(problem);
    const double       E      = problem.youngs_modulus;
    const unsigned int n_dofs = 2 * problem.mesh.nodes.size();

    const Eigen::SparseMatrix<double> A =
      stiffness(problem.mesh, problem.poisson_ratio);
    const Eigen::VectorXd             f = problem.forces.size() > 0
                  ? Eigen::VectorXd(problem.forces / E)
                  : Eigen::VectorXd::Zero(n_dofs);
    const Eigen::SparseMatrix<double> A_free =
      space.basis.transpose() * A * space.basis;
    const Eigen::VectorXd f_free =
      space.basis.transpose() * (f - A * space.offset);

    // Split the free degrees of freedom in those of contact nodes, in their
    // frames, and the others.
    CondensedProblem condensed;
    condensed.law = problem.friction;
    std::vector<unsigned int>           original; // number in problem.contact
    std::vector<bool>                   is_contact(A_free.rows(), false);
    std::vector<Eigen::Triplet<double>> frame_entries;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const ContactNode &node = problem.contact[p];
        const int          i = space.index[2 * node.node], j = i + 1;
        if (std::abs(node.normal.norm() - 1.) > 1e-12)
          throw std::runtime_error("Reference: a normal has not length one.");
        if (i < 0 && space.index[2 * node.node + 1] < 0)
          continue;
        if (i < 0 || space.index[2 * node.node + 1] < 0)
          throw std::runtime_error("Reference: one component of a contact node "
                                   "is prescribed; this is not supported.");
        const int       column = 2 * original.size();
        Eigen::Vector2d t      = tangent(node.normal);
        for (unsigned int c = 0; c < 2; ++c)
          {
            frame_entries.emplace_back(i + c, column, node.normal[c]);
            frame_entries.emplace_back(i + c, column + 1, t[c]);
          }
        is_contact[i] = is_contact[j] = true;
        original.push_back(p);
        condensed.nodes.push_back(node);
        condensed.nodes.back().friction_bound /= E;
      }
    Eigen::SparseMatrix<double> frame(A_free.rows(), 2 * original.size());
    frame.setFromTriplets(frame_entries.begin(), frame_entries.end());
    std::vector<Eigen::Triplet<double>> interior_entries;
    unsigned int                        n_interior = 0;
    for (int i = 0; i < A_free.rows(); ++i)
      if (!is_contact[i])
        interior_entries.emplace_back(i, n_interior++, 1.);
    Eigen::SparseMatrix<double> interior(A_free.rows(), n_interior);
    interior.setFromTriplets(interior_entries.begin(), interior_entries.end());

    const Eigen::SparseMatrix<double> A_ii =
      interior.transpose() * A_free * interior;
    const Eigen::SparseMatrix<double> A_ic =
      interior.transpose() * A_free * frame;
    const Eigen::SparseMatrix<double> A_cc = frame.transpose() * A_free * frame;
    const Eigen::VectorXd             f_i  = interior.transpose() * f_free;

    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(A_ii);
    if (factors.info() != Eigen::Success || factors.vectorD().minCoeff() <= 0.)
      throw std::runtime_error(
        "Reference: the body can move freely although its contact nodes are "
        "held.");
    const auto solve_interior = [&](const Eigen::MatrixXd &right) {
      Eigen::MatrixXd x = factors.solve(right);
      // One step of refinement, since the results are compared to many digits.
      x += factors.solve(Eigen::MatrixXd(right - A_ii * x));
      return x;
    };

    // K = A_cc - A_ci A_ii^-1 A_ic, symmetrised against rounding.
    const Eigen::MatrixXd response = solve_interior(Eigen::MatrixXd(A_ic));
    const Eigen::MatrixXd load     = solve_interior(f_i);
    condensed.K = Eigen::MatrixXd(A_cc) - A_ic.transpose() * response;
    condensed.K = (0.5 * (condensed.K + condensed.K.transpose())).eval();
    condensed.b = frame.transpose() * f_free - A_ic.transpose() * load;

    ContactSolution solution;
    Eigen::VectorXd v = Eigen::VectorXd::Zero(condensed.K.rows());
    if (v.size() > 0)
      {
        // Forces that hold the contact nodes in place: the unit of "small".
        Eigen::VectorXd held = v;
        for (unsigned int p = 0; p < original.size(); ++p)
          held[2 * p] = condensed.nodes[p].gap;
        condensed.force_scale = std::max(
          (condensed.K * held - condensed.b).cwiseAbs().maxCoeff(), 1e-300);

        const bool has_friction = problem.friction != Friction::none;
        Phase      start;
        start.tangential = has_friction ? Phase::stick : Phase::free;
        std::vector<Phase> phases(original.size(), start);
        // Phases for which no friction can act never stick.
        phases = condensed.predicted_phases(phases, held);
        if (method == Method::relaxation)
          condensed.relax(phases, v);
        else if (!condensed.active_set(phases, v, solution.active_set_steps))
          {
            solution.relaxation_was_needed = true;
            condensed.relax(phases, v);
            // Bring the last digits in by an exact solve, if the phases have
            // settled.
            std::vector<Phase> settled = condensed.predicted_phases(phases, v);
            Eigen::VectorXd    polished;
            unsigned int       steps;
            if (condensed.active_set(settled, polished, steps))
              v = polished;
          }
      }

    const Eigen::VectorXd x_i = solve_interior(f_i - A_ic * v); // the
                                                                // eliminated
                                                                // nodes
    solution.displacement =
      space.basis * (interior * x_i + frame * v) + space.offset;
    solution.residual = E *
      (space.distribute.transpose() * (A * solution.displacement - f)).eval();

    const unsigned int n_contact = problem.contact.size();
    solution.state.assign(n_contact, State::open);
    solution.normal_force.setZero(n_contact);
    solution.tangential_force.setZero(n_contact);
    solution.slip.setZero(n_contact);
    for (unsigned int p = 0; p < n_contact; ++p)
      {
        const ContactNode    &node = problem.contact[p];
        const Eigen::Vector2d R = solution.residual.segment<2>(2 * node.node),
                              u =
                                solution.displacement.segment<2>(2 * node.node);
        solution.normal_force[p]     = -R.dot(node.normal);
        solution.tangential_force[p] = R.dot(tangent(node.normal));
        solution.slip[p]             = u.dot(tangent(node.normal));
      }
    // The states are those of the final phases, as v determines them.
    if (!original.empty())
      {
        Phase rest;
        rest.touches      = true;
        rest.tangential   = Phase::stick;
        const auto phases = condensed.predicted_phases(
          std::vector<Phase>(original.size(), rest), v);
        for (unsigned int q = 0; q < original.size(); ++q)
          if (phases[q].touches)
            solution.state[original[q]] = phases[q].tangential == Phase::stick
              ? State::sticking
              : State::sliding;
      }

    solution.violations = check(problem, solution.displacement);
    if (!(solution.violations.max() <= 1e-10))
      {
        std::ostringstream message;
        message << "Reference: no solution was found; the law is violated by "
                << solution.violations.max()
                << " (relative). There may be none near, or several.";
        throw std::runtime_error(message.str());
      }
    return solution;
  }
} // namespace Reference
