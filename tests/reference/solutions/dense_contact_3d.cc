#include <Eigen/Geometry>
#include <Eigen/Sparse>
#include <tests/reference/solutions/both_dimensions.h>
#include <tests/reference/solutions/dense_contact_3d.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace Reference
{
  Eigen::SparseMatrix<double>
  stiffness(const Mesh3D &mesh, const double nu)
  {
    const double lambda = nu / ((1. + nu) * (1. - 2. * nu));
    const double mu     = 1. / (2. * (1. + nu));
    const double q      = 1. / std::sqrt(3.);

    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(576 * mesh.cells.size());
    for (const auto &cell : mesh.cells)
      {
        Eigen::Matrix<double, 24, 24> cell_matrix;
        cell_matrix.setZero();
        for (unsigned int point = 0; point < 8; ++point)
          {
            // Vertex v of [-1,1]^3 has the coordinates +-1 by the bits of v;
            // so have the Gauss points, closer to the centre.
            Eigen::Matrix<double, 8, 3> reference_gradients;
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int d = 0; d < 3; ++d)
                {
                  double derivative = 0.125;
                  for (unsigned int e = 0; e < 3; ++e)
                    {
                      const double sign = (v >> e) & 1 ? 1. : -1.;
                      const double xi   = (point >> e) & 1 ? q : -q;
                      derivative *= e == d ? sign : 1. + sign * xi;
                    }
                  reference_gradients(v, d) = derivative;
                }
            Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
            for (unsigned int v = 0; v < 8; ++v)
              jacobian += mesh.nodes[cell[v]] * reference_gradients.row(v);
            const double det = jacobian.determinant();
            if (det <= 0.)
              throw std::runtime_error(
                "Reference: a cell is degenerate or its vertices are not in "
                "lexicographic order.");
            const Eigen::Matrix<double, 8, 3> gradients =
              reference_gradients * jacobian.inverse();

            // lambda div u div v + mu (grad u : grad v + grad u : grad v^T)
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int w = 0; w < 8; ++w)
                {
                  const Eigen::Vector3d a = gradients.row(v),
                                        b = gradients.row(w);
                  cell_matrix.block<3, 3>(3 * v, 3 * w) += det *
                    (lambda * a * b.transpose() + mu * b * a.transpose() +
                     mu * a.dot(b) * Eigen::Matrix3d::Identity());
                }
          }
        for (unsigned int i = 0; i < 24; ++i)
          for (unsigned int j = 0; j < 24; ++j)
            entries.emplace_back(3 * cell[i / 3] + i % 3,
                                 3 * cell[j / 3] + j % 3,
                                 cell_matrix(i, j));
      }

    Eigen::SparseMatrix<double> matrix(3 * mesh.nodes.size(),
                                       3 * mesh.nodes.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }



  std::vector<bool>
  prescribed(const ContactProblem3D &problem)
  {
    std::vector<bool> result(3 * problem.mesh.nodes.size(), false);
    for (const auto &d : problem.dirichlet)
      result[3 * d.node + d.component] = true;
    return result;
  }



  bool
  wholly_prescribed(const std::vector<bool> &prescribed,
                    const unsigned int       node)
  {
    return prescribed[3 * node] && prescribed[3 * node + 1] &&
      prescribed[3 * node + 2];
  }



  namespace
  {


    /**
     * The problem condensed to the contact nodes. In the frames (n,t_1,t_2) of
     * the nodes R = K v - b.
     *
     * The law is an equation without inequalities, that of Alart and Curnier
     * (1991). With a stiffness k > 0 of the node and the projection P_s onto
     * the disc of radius s,
     *
     *   R_n + max(tau^, 0) = 0,   tau^ = -R_n + k_n (v_n - g),
     *   R_T + P_s(z)       = 0,   z    = -R_T + k_T v_T,
     *
     * s being F max(tau^, 0) by Coulomb's law. Its solutions do not depend on
     * the k, which are no penalty: they only weigh a length against a force.
     */
    struct CondensedProblem3D
    {
      struct Node
      {
        double              gap;
        double              friction_coefficient;
        double              friction_bound;
        std::array<bool, 2> held; ///< t_1, t_2 prescribed to be zero
      };

      Eigen::MatrixXd   K;
      Eigen::VectorXd   b;
      Friction          law;
      std::vector<Node> nodes;
      double            force_scale = 1.;

      double
      k_n(const unsigned int p) const
      {
        return K(3 * p, 3 * p);
      }

      /// One number for both tangents, or the law would depend on their choice.
      double
      k_T(const unsigned int p) const
      {
        return 0.5 * (K(3 * p + 1, 3 * p + 1) + K(3 * p + 2, 3 * p + 2));
      }

      /// Friction bound at a normal force, of the given fraction of friction.
      double
      bound(const Node &node, const double tau, const double fraction) const
      {
        switch (law)
          {
            case Friction::tresca:
              return fraction * node.friction_bound;
            case Friction::coulomb:
              return fraction * node.friction_coefficient * std::max(tau, 0.);
            default:
              return 0.;
          }
      }

      /// A tangential vector without its held components.
      static Eigen::Vector2d
      free_part(const Node &node, Eigen::Vector2d vector)
      {
        for (unsigned int c = 0; c < 2; ++c)
          if (node.held[c])
            vector[c] = 0.;
        return vector;
      }

      /**
       * What is missing to the law at v, zero at a solution, and on demand one
       * of its generalised derivatives.
       */
      Eigen::VectorXd
      defect(const Eigen::VectorXd &v,
             const double           fraction,
             Eigen::MatrixXd       *derivative = nullptr) const
      {
        const Eigen::VectorXd R = K * v - b;
        Eigen::VectorXd       G = R;
        if (derivative != nullptr)
          *derivative = K;

        for (unsigned int p = 0; p < nodes.size(); ++p)
          {
            const Node           &node  = nodes[p];
            const unsigned int    i     = 3 * p;
            const Eigen::Vector2d v_T   = v.segment<2>(i + 1);
            const Eigen::Vector2d R_T   = R.segment<2>(i + 1);
            const double          tau   = -R[i] + k_n(p) * (v[i] - node.gap);
            const double          s     = bound(node, tau, fraction);
            const Eigen::Vector2d z     = free_part(node, -R_T + k_T(p) * v_T);
            const double          z_abs = z.norm();
            const bool            stick = s > 0. && z_abs <= s;

            if (tau > 0.)
              {
                G[i] = k_n(p) * (v[i] - node.gap);
                if (derivative != nullptr)
                  {
                    derivative->row(i).setZero();
                    (*derivative)(i, i) = k_n(p);
                  }
              }

            if (!stick && s > 0.)
              {
                const Eigen::Vector2d direction = z / z_abs;
                G.segment<2>(i + 1) += s * direction;
                if (derivative != nullptr)
                  {
                    // P_s(z) = s z/|z| turns with z and grows with s.
                    Eigen::Matrix2d turn = s / z_abs *
                      (Eigen::Matrix2d::Identity() -
                       direction * direction.transpose());
                    for (unsigned int c = 0; c < 2; ++c)
                      if (node.held[c])
                        turn.col(c).setZero();
                    derivative->middleRows<2>(i + 1) -=
                      turn * K.middleRows<2>(i + 1);
                    derivative->block<2, 2>(i + 1, i + 1) += k_T(p) * turn;
                    if (law == Friction::coulomb)
                      {
                        const double F = fraction * node.friction_coefficient;
                        derivative->middleRows<2>(i + 1) -=
                          F * direction * K.row(i);
                        derivative->block<2, 1>(i + 1, i) +=
                          F * k_n(p) * direction;
                      }
                  }
              }

            for (unsigned int c = 0; c < 2; ++c)
              if (stick || node.held[c])
                {
                  const unsigned int j = i + 1 + c;
                  G[j]                 = k_T(p) * v[j];
                  if (derivative != nullptr)
                    {
                      derivative->row(j).setZero();
                      (*derivative)(j, j) = k_T(p);
                    }
                }
          }
        return G;
      }

      /**
       * Newton's method with a search along the line for a smaller defect.
       * Returns false, leaving v as it was, when the defect does not come down
       * to rounding.
       */
      bool
      newton(Eigen::VectorXd &v,
             const double     fraction,
             unsigned int    &steps) const
      {
        Eigen::VectorXd w = v;
        Eigen::MatrixXd derivative;
        double          size = defect(w, fraction).norm();
        for (unsigned int step = 0; step < 100 && size > 0.; ++step, ++steps)
          {
            const Eigen::VectorXd G = defect(w, fraction, &derivative);
            const Eigen::PartialPivLU<Eigen::MatrixXd> lu(derivative);
            Eigen::VectorXd                            dw = lu.solve(-G);
            dw += lu.solve(-G - derivative * dw);
            if (!dw.allFinite())
              return false;

            // Once at the solution, only full steps that gain much are steps;
            // the others are rounding.
            const bool arrived = size <= 1e-12 * force_scale;
            double     damping = 1., next = defect(w + dw, fraction).norm();
            while (!arrived && damping > 1e-4 &&
                   next > (1. - 1e-3 * damping) * size)
              {
                damping *= 0.5;
                next = defect(w + damping * dw, fraction).norm();
              }
            if (next >= (arrived ? 0.5 : 1.) * size)
              break;
            w += damping * dw;
            size = next;
          }
        if (size > 1e-12 * force_scale)
          return false;
        v = w;
        return true;
      }

      /**
       * From the frictionless solution, which is that of a convex problem, to
       * the one with friction: at once if Newton's method manages, otherwise in
       * as many steps as it needs.
       */
      bool
      continuation(Eigen::VectorXd &v,
                   unsigned int    &newton_steps,
                   unsigned int    &continuation_steps) const
      {
        if (!newton(v, 0., newton_steps))
          return false;
        double fraction = 0., step = 1.;
        while (fraction < 1. && step > 1e-4)
          if (newton(v, std::min(fraction + step, 1.), newton_steps))
            {
              fraction = std::min(fraction + step, 1.);
              step *= 2.;
              ++continuation_steps;
            }
          else
            step *= 0.25;
        return fraction == 1.;
      }

      /// The state that the pair (v,R) of a solution is in.
      State
      state(const unsigned int p, const Eigen::VectorXd &v) const
      {
        const unsigned int    i     = 3 * p;
        const Node           &node  = nodes[p];
        const Eigen::Vector3d R     = K.middleRows<3>(i) * v - b.segment<3>(i);
        const double          noise = 1e-13 * force_scale;
        if (-R[0] < k_n(p) * (node.gap - v[i]) - noise)
          return State::open;
        const double s   = bound(node, -R[0], 1.);
        const double R_T = free_part(node, R.tail<2>()).norm();
        const double v_T = free_part(node, v.segment<2>(i + 1)).norm();
        return s > 0. && k_T(p) * v_T <= s - R_T + noise ? State::sticking
                                                         : State::sliding;
      }
    };


    /**
     * The frame (n,t_1,t_2) of a contact node as columns; components that are
     * prescribed at it become tangents.
     */
    Eigen::Matrix3d
    frame(const ContactProblem3D  &problem,
          const std::vector<bool> &fixed,
          const ContactNode3D     &node,
          std::array<bool, 2>     &held)
    {
      if (std::abs(node.normal.norm() - 1.) > 1e-12)
        throw std::runtime_error("Reference: a normal has not length one.");
      for (const auto &d : problem.dirichlet)
        if (d.node == node.node &&
            (node.normal[d.component] != 0. || d.value != 0.))
          throw std::runtime_error(
            "Reference: what is prescribed at a contact node is neither "
            "everything nor zero along a tangent; this is not supported.");

      std::vector<Eigen::Vector3d> prescribed_tangents;
      for (unsigned int c = 0; c < 3; ++c)
        if (fixed[3 * node.node + c])
          prescribed_tangents.push_back(Eigen::Vector3d::Unit(c));

      Eigen::Matrix3d result;
      result.col(0) = node.normal;
      held = {{prescribed_tangents.size() > 1, prescribed_tangents.size() > 0}};
      if (held[1])
        result.col(2) = prescribed_tangents[0];
      else
        result.col(2) = node.normal.unitOrthogonal();
      result.col(1) = result.col(2).cross(node.normal);
      return result;
    }
  } // namespace



  Violations
  check(const ContactProblem3D &problem, const Eigen::VectorXd &u)
  {
    const std::vector<bool> fixed = prescribed(problem);
    const double            E     = problem.youngs_modulus;
    Eigen::VectorXd R = stiffness(problem.mesh, problem.poisson_ratio) * u;
    if (problem.forces.size() > 0)
      R -= problem.forces / E;

    const Scales scales(problem, u, R);
    const double force = scales.force, length = scales.length;

    Violations        v;
    std::vector<bool> may_touch(problem.mesh.nodes.size(), false);
    for (const auto &node : problem.contact)
      {
        may_touch[node.node] = true;
        if (wholly_prescribed(fixed, node.node))
          continue;
        const Eigen::Vector3d u_p = u.segment<3>(3 * node.node) / length,
                              R_p = R.segment<3>(3 * node.node) / force;
        const double    distance  = node.gap / length - u_p.dot(node.normal);
        const double    tau       = -R_p.dot(node.normal);
        Eigen::Vector3d u_T       = u_p - u_p.dot(node.normal) * node.normal,
                        R_T       = R_p + tau * node.normal;
        for (unsigned int c = 0; c < 3; ++c)
          if (fixed[3 * node.node + c]) // a reaction, not friction
            u_T[c] = R_T[c] = 0.;
        double s = 0.;
        if (problem.friction == Friction::coulomb)
          s = node.friction_coefficient * std::max(tau, 0.);
        else if (problem.friction == Friction::tresca)
          s = node.friction_bound / (E * force);

        v.penetration = std::max(v.penetration, -distance);
        v.tension     = std::max(v.tension, -tau);
        v.complementarity =
          std::max(v.complementarity, std::min(tau, distance));
        v.cone = std::max(v.cone, R_T.norm() - s);
        v.slip = std::max(v.slip, std::min(s - R_T.norm(), u_T.norm()));
        if (u_T.norm() > 0.) // opposed to the force wherever it slips
          v.slip = std::max(
            v.slip, std::min((R_T + s / u_T.norm() * u_T).norm(), u_T.norm()));
      }
    for (unsigned int i = 0; i < fixed.size(); ++i)
      if (!fixed[i] && !may_touch[i / 3])
        v.equilibrium = std::max(v.equilibrium, std::abs(R[i]) / force);
    for (const auto &d : problem.dirichlet)
      v.equilibrium =
        std::max(v.equilibrium,
                 std::abs(u[3 * d.node + d.component] - d.value) / length);
    return v;
  }



  ContactSolution3D
  solve(const ContactProblem3D &problem)
  {
    const double            E      = problem.youngs_modulus;
    const unsigned int      n_dofs = 3 * problem.mesh.nodes.size();
    const std::vector<bool> fixed  = prescribed(problem);

    const Eigen::SparseMatrix<double> A =
      stiffness(problem.mesh, problem.poisson_ratio);
    const Eigen::VectorXd f      = problem.forces.size() > 0
           ? Eigen::VectorXd(problem.forces / E)
           : Eigen::VectorXd::Zero(n_dofs);
    Eigen::VectorXd       offset = Eigen::VectorXd::Zero(n_dofs);
    for (const auto &d : problem.dirichlet)
      offset[3 * d.node + d.component] = d.value;

    // u = interior x + frames v + offset, v being the displacements of the
    // contact nodes in their frames.
    CondensedProblem3D condensed;
    condensed.law = problem.friction;
    std::vector<unsigned int>           original; // number in problem.contact
    std::vector<bool>                   is_contact(problem.mesh.nodes.size());
    std::vector<Eigen::Triplet<double>> frame_entries, interior_entries;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const ContactNode3D &node = problem.contact[p];
        if (wholly_prescribed(fixed, node.node))
          continue;
        std::array<bool, 2>   held;
        const Eigen::Matrix3d axes = frame(problem, fixed, node, held);
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int d = 0; d < 3; ++d)
            frame_entries.emplace_back(
              3 * node.node + c, 3 * original.size() + d, axes(c, d));
        is_contact[node.node] = true;
        original.push_back(p);
        condensed.nodes.push_back(
          {node.gap, node.friction_coefficient, node.friction_bound / E, held});
      }
    unsigned int n_interior = 0;
    for (unsigned int i = 0; i < n_dofs; ++i)
      if (!is_contact[i / 3] && !fixed[i])
        interior_entries.emplace_back(i, n_interior++, 1.);
    Eigen::SparseMatrix<double> frames(n_dofs, 3 * original.size()),
      interior(n_dofs, n_interior);
    frames.setFromTriplets(frame_entries.begin(), frame_entries.end());
    interior.setFromTriplets(interior_entries.begin(), interior_entries.end());

    const Eigen::SparseMatrix<double> A_ii =
      interior.transpose() * A * interior;
    const Eigen::SparseMatrix<double> A_ic = interior.transpose() * A * frames;
    const Eigen::SparseMatrix<double> A_cc = frames.transpose() * A * frames;
    const Eigen::VectorXd             load = f - A * offset;
    const Eigen::VectorXd             f_i  = interior.transpose() * load;

    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
    if (n_interior > 0)
      factors.compute(A_ii);
    if (n_interior > 0 &&
        (factors.info() != Eigen::Success ||
         factors.vectorD().minCoeff() <= 0.))
      throw std::runtime_error(
        "Reference: the body can move freely although its contact nodes are "
        "held.");
    const auto solve_interior = [&](const Eigen::VectorXd &right) {
      if (n_interior == 0)
        return right;
      Eigen::VectorXd x = factors.solve(right);
      // One step of refinement, since the results are compared to many digits.
      x += factors.solve(Eigen::VectorXd(right - A_ii * x));
      return x;
    };

    // K = A_cc - A_ci A_ii^-1 A_ic, symmetrised against rounding.
    Eigen::MatrixXd response = Eigen::MatrixXd(A_ic);
    if (n_interior > 0)
      response = factors.solve(response).eval();
    condensed.K = Eigen::MatrixXd(A_cc) - A_ic.transpose() * response;
    condensed.K = (0.5 * (condensed.K + condensed.K.transpose())).eval();
    condensed.b =
      frames.transpose() * load - A_ic.transpose() * solve_interior(f_i);

    // Start from contact nodes held in touch. Their forces are the unit of
    // "small".
    ContactSolution3D solution;
    Eigen::VectorXd   v = Eigen::VectorXd::Zero(condensed.K.rows());
    for (unsigned int q = 0; q < original.size(); ++q)
      v[3 * q] = condensed.nodes[q].gap;
    if (v.size() > 0)
      {
        condensed.force_scale = std::max(
          (condensed.K * v - condensed.b).cwiseAbs().maxCoeff(), 1e-300);
        if (!condensed.continuation(
              v, solution.newton_steps, solution.continuation_steps))
          throw std::runtime_error(
            "Reference: Newton's method finds no solution, not by small steps "
            "in the friction either.");
      }

    solution.displacement =
      interior * solve_interior(f_i - A_ic * v) + frames * v + offset;
    const Eigen::VectorXd A_u = A * solution.displacement;
    solution.residual         = E * (A_u - f);
    solution.potential_energy = E * solution.displacement.dot(0.5 * A_u - f);

    solution.state.assign(problem.contact.size(), State::open);
    solution.normal_force.setZero(problem.contact.size());
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const ContactNode3D  &node = problem.contact[p];
        const Eigen::Vector3d R = solution.residual.segment<3>(3 * node.node),
                              u =
                                solution.displacement.segment<3>(3 * node.node);
        const double tau         = -R.dot(node.normal);
        solution.normal_force[p] = tau;
        solution.tangential_force.push_back(R + tau * node.normal);
        solution.slip.push_back(u - u.dot(node.normal) * node.normal);
      }
    for (unsigned int q = 0; q < original.size(); ++q)
      {
        const unsigned int p = original[q];
        solution.state[p]    = condensed.state(q, v);
        solution.friction_energy += E *
          condensed.bound(
            condensed.nodes[q], solution.normal_force[p] / E, 1.) *
          solution.slip[p].norm();
      }

    solution.violations = check(problem, solution.displacement);
    if (!(solution.violations.max() <= 1e-10))
      {
        std::ostringstream message;
        message << "Reference: no solution was found; the law is violated by "
                << solution.violations.max() << " (relative).";
        throw std::runtime_error(message.str());
      }
    return solution;
  }
} // namespace Reference
