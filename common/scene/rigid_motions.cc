#include <common/input_error.h>
#include <common/scene/rigid_motions.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/vector.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>

namespace Friction
{
  namespace
  {
    // Translations first, then rotations about the centre of the part, which
    // move its farthest point by as much.
    template <int dim>
    constexpr unsigned int n_motions = dim *(dim + 1) / 2;



    /** A connected part of the body. */
    template <int dim>
    struct Part
    {
      std::vector<unsigned int>    cells;
      Point<dim>                   lower, upper;
      std::set<types::material_id> materials;
      std::set<types::boundary_id> boundary_ids;

      Point<dim>
      center() const
      {
        return lower + .5 * (upper - lower);
      }

      double
      size() const
      {
        return .5 * lower.distance(upper);
      }

      // The displacement of a point by each of the motions, as columns.
      Eigen::MatrixXd
      motions_at(const Point<dim> &p) const
      {
        const Tensor<1, dim> arm = (p - center()) / size();
        Eigen::MatrixXd      m   = Eigen::MatrixXd::Zero(dim, n_motions<dim>);
        for (unsigned int d = 0; d < dim; ++d)
          m(d, d) = 1.;
        if constexpr (dim == 2)
          {
            m(0, 2) = -arm[1];
            m(1, 2) = arm[0];
          }
        else
          // The rotation around axis d.
          for (unsigned int d = 0; d < 3; ++d)
            {
              m((d + 1) % 3, 3 + d) = -arm[(d + 2) % 3];
              m((d + 2) % 3, 3 + d) = arm[(d + 1) % 3];
            }
        return m;
      }
    };



    // What is only rounding, compared with a size, would look important.
    template <int dim>
    std::string
    describe(const Tensor<1, dim> &v, const double size)
    {
      std::ostringstream text;
      text.precision(4);
      text << '(';
      for (unsigned int d = 0; d < dim; ++d)
        text << (d > 0 ? ", " : "")
             << (std::abs(v[d]) < 1e-10 * size ? 0. : v[d]);
      text << ')';
      return text.str();
    }



    template <int dim>
    std::string
    describe_direction(const Tensor<1, dim> &v)
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(std::abs(v[d]) - v.norm()) < 1e-8 * v.norm())
          return std::string(1, "xyz"[d]) + " direction";
      return "direction " + describe<dim>(v / v.norm(), 1.);
    }



    // The motion in words.
    template <int dim>
    std::string
    describe_motion(const Eigen::VectorXd &m, const Part<dim> &part)
    {
      Tensor<1, dim> shift, turn;
      for (unsigned int d = 0; d < dim; ++d)
        shift[d] = m[d];
      for (unsigned int d = dim; d < n_motions<dim>; ++d)
        turn[d - dim] = m[d];
      if (turn.norm() < 1e-6 * m.norm())
        return "a displacement in " + describe_direction(shift);
      turn /= part.size();

      // The point, or the axis, that stays where it is.
      if constexpr (dim == 2)
        {
          const Tensor<1, 2> to_center(
            {-shift[1] / turn[0], shift[0] / turn[0]});
          return "a rotation around " +
            describe<dim>(part.center() + to_center, part.size());
        }
      else
        {
          const Tensor<1, dim> axis = turn / turn.norm();
          const Tensor<1, dim> to_axis =
            cross_product_3d(turn, shift) / turn.norm_square();
          return "a rotation around the axis through " +
            describe<dim>(part.center() + to_axis, part.size()) + " in " +
            describe_direction(axis) +
            (std::abs(shift * axis) > 1e-6 * m.norm()
               ? " together with a displacement along it"
               : "");
        }
    }



    // A basis of simple vectors: each has a component that the others have not.
    Eigen::MatrixXd
    simple_basis(Eigen::MatrixXd basis)
    {
      unsigned int next = 0;
      for (unsigned int row = 0; row < basis.rows() && next < basis.cols();
           ++row)
        {
          Eigen::Index pivot;
          const double largest = basis.row(row)
                                   .tail(basis.cols() - next)
                                   .cwiseAbs()
                                   .maxCoeff(&pivot);
          if (largest < 1e-6)
            continue;
          basis.col(next).swap(basis.col(next + pivot));
          basis.col(next) /= basis(row, next);
          for (unsigned int c = 0; c < basis.cols(); ++c)
            if (c != next)
              basis.col(c) -= basis(row, c) * basis.col(next);
          ++next;
        }
      return basis;
    }



    // The remainder of the best approximation of loads by contact * lambda,
    // lambda >= 0: the method of Lawson and Hanson, which lets one column after
    // the other take part. There are never more of them than rows.
    Eigen::VectorXd
    unbalanced(const Eigen::VectorXd &loads, const Eigen::MatrixXd &contact)
    {
      const unsigned int        n      = contact.cols();
      Eigen::VectorXd           lambda = Eigen::VectorXd::Zero(n);
      std::vector<unsigned int> active;
      Eigen::VectorXd           rest      = loads;
      const double              tolerance = 1e-10;
      for (unsigned int step = 0; step < 10 * n + 100; ++step)
        {
          if (n == 0)
            break;
          Eigen::VectorXd gain = contact.transpose() * rest;
          for (const unsigned int p : active)
            gain[p] = -1.;
          Eigen::Index best;
          if (gain.maxCoeff(&best) <= tolerance)
            break;
          active.push_back(best);
          while (!active.empty())
            {
              Eigen::MatrixXd columns(contact.rows(), active.size());
              for (unsigned int i = 0; i < active.size(); ++i)
                columns.col(i) = contact.col(active[i]);
              const Eigen::VectorXd wanted =
                columns.colPivHouseholderQr().solve(loads);
              double way = 1.;
              for (unsigned int i = 0; i < active.size(); ++i)
                if (wanted[i] <= 0.)
                  way = std::min(
                    way, lambda[active[i]] / (lambda[active[i]] - wanted[i]));
              for (unsigned int i = 0; i < active.size(); ++i)
                lambda[active[i]] += way * (wanted[i] - lambda[active[i]]);
              if (way == 1.)
                break;
              for (unsigned int i = active.size(); i-- > 0;)
                if (lambda[active[i]] <= 1e-14 * lambda.maxCoeff() ||
                    lambda[active[i]] <= 0.)
                  {
                    lambda[active[i]] = 0.;
                    active.erase(active.begin() + i);
                  }
            }
          rest = loads - contact * lambda;
        }
      return rest;
    }
  } // namespace



  Holding
  held_by_contact(const Eigen::VectorXd &loads, const Eigen::MatrixXd &contact)
  {
    Holding result;
    if (loads.size() == 0)
      return result;
    Eigen::MatrixXd directions(contact.rows(), 0);
    for (unsigned int p = 0; p < contact.cols(); ++p)
      if (contact.col(p).norm() > 1e-8)
        {
          directions.conservativeResize(Eigen::NoChange, directions.cols() + 1);
          directions.col(directions.cols() - 1) = contact.col(p).normalized();
        }

    Eigen::VectorXd scaled = loads;
    if (loads.norm() > 0.)
      {
        scaled.normalize();
        const Eigen::VectorXd rest = unbalanced(scaled, directions);
        if (rest.norm() > 1e-6)
          {
            result.motion    = rest.normalized();
            result.is_driven = true;
            return result;
          }
      }

    // The loads of a neighbourhood.
    const double neighbourhood = 1e-3;
    for (unsigned int i = 0; i < loads.size(); ++i)
      for (const double sign : {1., -1.})
        {
          Eigen::VectorXd other = scaled;
          other[i] += sign * neighbourhood;
          const Eigen::VectorXd rest = unbalanced(other, directions);
          if (rest.norm() > 1e-3 * neighbourhood)
            {
              result.motion = rest.normalized();
              return result;
            }
        }
    return result;
  }



  template <int dim>
  unsigned int
  find_parts(const Triangulation<dim>  &mesh,
             std::vector<unsigned int> &part_of_cell)
  {
    part_of_cell.assign(mesh.n_active_cells(), numbers::invalid_unsigned_int);
    unsigned int                                                   n_parts = 0;
    std::vector<typename Triangulation<dim>::active_cell_iterator> front;
    for (const auto &first : mesh.active_cell_iterators())
      if (part_of_cell[first->active_cell_index()] ==
          numbers::invalid_unsigned_int)
        {
          part_of_cell[first->active_cell_index()] = n_parts;
          front.push_back(first);
          while (!front.empty())
            {
              const auto cell = front.back();
              front.pop_back();
              for (const unsigned int f : cell->face_indices())
                if (!cell->at_boundary(f))
                  {
                    const typename Triangulation<dim>::active_cell_iterator
                                  neighbor = cell->neighbor(f);
                    unsigned int &part =
                      part_of_cell[neighbor->active_cell_index()];
                    if (part == numbers::invalid_unsigned_int)
                      {
                        part = n_parts;
                        front.push_back(neighbor);
                      }
                  }
            }
          ++n_parts;
        }
    return n_parts;
  }



  namespace
  {
    template <int dim>
    Eigen::VectorXd
    as_vector(const Tensor<1, dim> &v)
    {
      Eigen::VectorXd result(dim);
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = v[d];
      return result;
    }



    // Everything about one part: its free motions, loads, and contact.
    template <int dim>
    class FreePart
    {
    public:
      explicit FreePart(const Scene<dim> &scene)
        : scene(scene)
        , cell_values(
            fe, QGauss<dim>(3), update_quadrature_points | update_JxW_values)
        , face_values(fe,
                      QGauss<dim - 1>(3),
                      update_quadrature_points | update_JxW_values |
                        update_normal_vectors)
      {}

      // An orthonormal basis of the motions that displacements allow.
      Eigen::MatrixXd
      free_motions(
        const Part<dim>          &part,
        const Triangulation<dim> &mesh,
        const std::vector<typename Triangulation<dim>::active_cell_iterator>
          &cells) const
      {
        (void)mesh;
        Eigen::MatrixXd gram =
          Eigen::MatrixXd::Zero(n_motions<dim>, n_motions<dim>);
        const auto prescribe = [&](const Point<dim>  &p,
                                   const unsigned int component) {
          const Eigen::VectorXd row =
            part.motions_at(p).row(component).transpose();
          gram += row * row.transpose();
        };
        for (const unsigned int c : part.cells)
          {
            for (const auto &face : cells[c]->face_iterators())
              if (face->at_boundary())
                for (const auto &condition : scene.dirichlet_conditions())
                  if (face->boundary_id() == condition.boundary_id)
                    for (const unsigned int v : face->vertex_indices())
                      for (unsigned int d = 0; d < dim; ++d)
                        if (condition.components[d])
                          prescribe(face->vertex(v), d);
            for (const auto &pin : scene.pinned_points())
              for (const unsigned int v : cells[c]->vertex_indices())
                if (cells[c]->vertex(v).distance(pin.point) <
                    1e-8 * cells[c]->diameter())
                  prescribe(pin.point, pin.component);
          }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
        unsigned int                                         n_free = 0;
        while (n_free < n_motions<dim> &&
               eigen.eigenvalues()[n_free] <=
                 1e-10 * std::max(1., eigen.eigenvalues()[n_motions<dim> - 1]))
          ++n_free;
        return eigen.eigenvectors().leftCols(n_free);
      }

      // What loads and contact do along the given motions.
      Holding
      holding(
        const Part<dim> &part,
        const std::vector<typename Triangulation<dim>::active_cell_iterator>
                              &cells,
        const Eigen::MatrixXd &motions)
      {
        Eigen::VectorXd loads = Eigen::VectorXd::Zero(motions.cols());
        std::vector<Eigen::VectorXd> normals;
        Vector<double>               load(dim);
        const auto add_load = [&](const Function<dim>     &function,
                                  const FEValuesBase<dim> &values) {
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const Point<dim> &p = values.quadrature_point(q);
              function.vector_value(p, load);
              Eigen::VectorXd force(dim);
              for (unsigned int d = 0; d < dim; ++d)
                force[d] = load[d] * values.JxW(q);
              loads +=
                motions.transpose() * part.motions_at(p).transpose() * force;
            }
        };
        for (const unsigned int c : part.cells)
          {
            if (scene.body_force() != nullptr)
              {
                cell_values.reinit(cells[c]);
                add_load(*scene.body_force(), cell_values);
              }
            for (const unsigned int f : cells[c]->face_indices())
              if (cells[c]->at_boundary(f))
                {
                  const auto face       = cells[c]->face(f);
                  const auto id         = face->boundary_id();
                  const bool is_contact = id == scene.contact_boundary_id();
                  bool       has_load   = false;
                  for (const auto &condition : scene.traction_conditions())
                    has_load |= id == condition.boundary_id;
                  if (!is_contact && !has_load)
                    continue;
                  face_values.reinit(cells[c], f);
                  for (const auto &condition : scene.traction_conditions())
                    if (id == condition.boundary_id)
                      add_load(*condition.traction, face_values);
                  if (!is_contact || scene.obstacle().empty())
                    continue;
                  for (const unsigned int v : face->vertex_indices())
                    {
                      const Point<dim>    &p = face->vertex(v);
                      const Tensor<1, dim> outward =
                        face_values.normal_vector(0);
                      const Tensor<1, dim> normal =
                        scene.contact_normal() == ContactNormal::body
                        ? outward
                        : scene.obstacle().normal(p);
                      if (normal * outward > Obstacle<dim>::flattest_cosine &&
                          std::isfinite(scene.obstacle().gap(p, normal)))
                        normals.push_back(motions.transpose() *
                                          part.motions_at(p).transpose() *
                                          as_vector<dim>(normal));
                    }
                }
          }
        Eigen::MatrixXd contact(motions.cols(), normals.size());
        for (unsigned int p = 0; p < normals.size(); ++p)
          contact.col(p) = normals[p];
        return held_by_contact(loads, contact);
      }

    private:
      const Scene<dim> &scene;
      const FE_Q<dim>   fe{1};
      FEValues<dim>     cell_values;
      FEFaceValues<dim> face_values;
    };



    template <typename Ids>
    std::string
    list(const Ids &ids)
    {
      std::string text;
      for (const auto id : ids)
        text += (text.empty() ? "" : ", ") + std::to_string(id);
      return text;
    }
  } // namespace



  template <int dim>
  void
  check_that_body_is_held(const Scene<dim>         &scene,
                          const Triangulation<dim> &mesh,
                          const std::string        &where)
  {
    std::vector<typename Triangulation<dim>::active_cell_iterator> cells;
    for (const auto &cell : mesh.active_cell_iterators())
      cells.push_back(cell);
    std::vector<unsigned int> part_of_cell;
    const unsigned int        n_parts = find_parts(mesh, part_of_cell);

    std::vector<Part<dim>> parts(n_parts);
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        Part<dim> &part = parts[part_of_cell[c]];
        for (const unsigned int v : cells[c]->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double x     = cells[c]->vertex(v)[d];
              const bool   first = part.cells.empty() && v == 0;
              part.lower[d]      = first ? x : std::min(part.lower[d], x);
              part.upper[d]      = first ? x : std::max(part.upper[d], x);
            }
        part.cells.push_back(c);
        part.materials.insert(cells[c]->material_id());
        for (const auto &face : cells[c]->face_iterators())
          if (face->at_boundary())
            part.boundary_ids.insert(face->boundary_id());
      }

    FreePart<dim> free_part(scene);
    for (const Part<dim> &part : parts)
      {
        const Eigen::MatrixXd motions =
          simple_basis(free_part.free_motions(part, mesh, cells));
        if (motions.cols() == 0)
          continue;
        const Holding holding = free_part.holding(part, cells, motions);
        if (holding.motion.size() == 0)
          continue;

        // Several free motions are listed, if nothing but displacements could
        // stop them; one that contact leaves is described as it is.
        std::string  what;
        unsigned int n_listed = 0;
        if (!holding.is_driven)
          for (unsigned int i = 0; i < motions.cols(); ++i)
            {
              const Eigen::MatrixXd one = motions.col(i);
              if (free_part.holding(part, cells, one).motion.size() == 0)
                continue;
              what += (n_listed > 0 ? " and " : "") +
                describe_motion<dim>(motions.col(i), part);
              ++n_listed;
            }
        if (n_listed == 0)
          what = describe_motion<dim>(motions * holding.motion, part);

        std::ostringstream name;
        if (n_parts == 1)
          name << "the body";
        else
          {
            name << "the part of the body in "
                 << describe<dim>(part.lower, part.size()) << " to "
                 << describe<dim>(part.upper, part.size()) << " ("
                 << part.cells.size() << " of " << cells.size()
                 << " coarse cells, which share no "
                 << (dim == 2 ? "edge" : "face") << " with the others";
            if (part.materials.size() > 1 || *part.materials.begin() > 0)
              name << ", physical id " << list(part.materials);
            name << ")";
          }
        const bool has_contact =
          part.boundary_ids.count(scene.contact_boundary_id()) > 0 &&
          !scene.obstacle().empty();
        throw InputError(
          where + name.str() + " is not held against " + what + ": " +
          (holding.is_driven ? "its loads push it there, and " : "") +
          "neither a displacement " +
          (has_contact ? "nor contact stops it" : "nor an obstacle stops it") +
          "; prescribe a displacement on one of its boundaries (" +
          list(part.boundary_ids) +
          ") in 'Boundary conditions/Displacement', or of a vertex in "
          "'Boundary "
          "conditions/Pinned points'.");
      }
  }



  template unsigned int find_parts(const Triangulation<2> &,
                                   std::vector<unsigned int> &);
  template unsigned int find_parts(const Triangulation<3> &,
                                   std::vector<unsigned int> &);
  template void         check_that_body_is_held(const Scene<2> &,
                                                const Triangulation<2> &,
                                                const std::string &);
  template void         check_that_body_is_held(const Scene<3> &,
                                                const Triangulation<3> &,
                                                const std::string &);
} // namespace Friction
