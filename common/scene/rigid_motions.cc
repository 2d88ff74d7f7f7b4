#include <common/dense_algebra.h>
#include <common/input_error.h>
#include <common/printable.h>
#include <common/scene/rigid_motions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

namespace Friction
{
  namespace
  {
    // Translations first, then rotations about the centre of the part, which
    // move its farthest point by as much.
    template <int dim>
    constexpr unsigned int n_motions = dim *(dim + 1) / 2;



    template <int dim>
    Point<dim>
    center(const FreePart<dim> &part)
    {
      return part.lower + .5 * (part.upper - part.lower);
    }



    template <int dim>
    double
    size(const FreePart<dim> &part)
    {
      return .5 * part.lower.distance(part.upper);
    }



    // The displacement of a point by each of the motions, as columns.
    template <int dim>
    Eigen::MatrixXd
    all_motions_at(const FreePart<dim> &part, const Point<dim> &p)
    {
      const Tensor<1, dim> arm = (p - center(part)) / size(part);
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
    describe_motion(const Eigen::VectorXd &m, const FreePart<dim> &part)
    {
      Tensor<1, dim> shift, turn;
      for (unsigned int d = 0; d < dim; ++d)
        shift[d] = m[d];
      for (unsigned int d = dim; d < n_motions<dim>; ++d)
        turn[d - dim] = m[d];
      if (turn.norm() < 1e-6 * m.norm())
        return "a displacement in " + describe_direction(shift);
      turn /= size(part);

      // The point, or the axis, that stays where it is.
      if constexpr (dim == 2)
        {
          const Tensor<1, 2> to_center(
            {-shift[1] / turn[0], shift[0] / turn[0]});
          return "a rotation around " +
            describe<dim>(center(part) + to_center, size(part));
        }
      else
        {
          const Tensor<1, dim> axis = turn / turn.norm();
          const Tensor<1, dim> to_axis =
            cross_product_3d(turn, shift) / turn.norm_square();
          return "a rotation around the axis through " +
            describe<dim>(center(part) + to_axis, size(part)) + " in " +
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
    // the other take part. There are never more of them than rows, so that a
    // step costs two products with all columns at most.
    Eigen::VectorXd
    unbalanced(const Eigen::VectorXd &loads, const Eigen::MatrixXd &contact)
    {
      const unsigned int        n      = contact.cols();
      Eigen::VectorXd           lambda = Eigen::VectorXd::Zero(n);
      Eigen::VectorXd           gain(n);
      std::vector<unsigned int> active;
      Eigen::VectorXd           rest      = loads;
      const double              tolerance = 1e-10;
      for (unsigned int step = 0; step < 200; ++step)
        {
          if (n == 0)
            break;
          gain.noalias() = contact.transpose() * rest;
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
              const Eigen::VectorXd wanted = least_squares(columns, loads);
              double                way    = 1.;
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
          rest = loads;
          for (const unsigned int p : active)
            rest -= lambda[p] * contact.col(p);
        }
      return rest;
    }
  } // namespace



  namespace
  {
    // The columns that are not nearly zero, with length one, and each once: on
    // a plane they are all the same, unless the body can be turned.
    Eigen::MatrixXd
    different_directions(const Eigen::MatrixXd &columns)
    {
      std::vector<Eigen::VectorXd> list;
      list.reserve(columns.cols());
      for (unsigned int p = 0; p < columns.cols(); ++p)
        if (columns.col(p).norm() > 1e-8)
          list.push_back(
            (columns.col(p).normalized() * 1e12).unaryExpr([](const double x) {
              return std::round(x) / 1e12 + 0.;
            }));
      std::sort(list.begin(),
                list.end(),
                [](const Eigen::VectorXd &a, const Eigen::VectorXd &b) {
                  return std::lexicographical_compare(a.data(),
                                                      a.data() + a.size(),
                                                      b.data(),
                                                      b.data() + b.size());
                });
      list.erase(std::unique(list.begin(), list.end()), list.end());
      Eigen::MatrixXd result(columns.rows(), list.size());
      for (unsigned int p = 0; p < list.size(); ++p)
        result.col(p) = list[p];
      return result;
    }
  } // namespace



  Eigen::VectorXd
  nearest_in_cone(const Eigen::VectorXd &v, const Eigen::MatrixXd &rays)
  {
    return v - unbalanced(v, rays);
  }



  Holding
  held_by_contact(const Eigen::VectorXd &loads, const Eigen::MatrixXd &contact)
  {
    Holding            result;
    const unsigned int n_rows = loads.size();
    if (n_rows == 0)
      return result;

    // In units in which contact nodes move by one at most: a small foot feels
    // little of a rotation, but is there to stop it.
    Eigen::VectorXd units = Eigen::VectorXd::Ones(n_rows);
    for (unsigned int i = 0; i < n_rows; ++i)
      if (contact.cols() > 0)
        {
          const double largest = contact.row(i).cwiseAbs().maxCoeff();
          if (largest > 1e-8)
            units[i] = 1. / largest;
        }
    const Eigen::MatrixXd directions =
      different_directions(units.asDiagonal() * contact);

    Eigen::VectorXd scaled = units.asDiagonal() * loads;
    const auto      motion = [&](const Eigen::VectorXd &rest) {
      return Eigen::VectorXd((units.asDiagonal() * rest).normalized());
    };
    if (scaled.norm() > 0.)
      {
        scaled.normalize();
        const Eigen::VectorXd rest = unbalanced(scaled, directions);
        if (rest.norm() > 1e-6)
          {
            result.motion    = motion(rest);
            result.is_driven = true;
            return result;
          }
      }

    // The loads of a neighbourhood.
    const double neighbourhood = 1e-4;
    for (unsigned int i = 0; i < n_rows; ++i)
      for (const double sign : {1., -1.})
        {
          Eigen::VectorXd other = scaled;
          other[i] += sign * neighbourhood;
          const Eigen::VectorXd rest = unbalanced(other, directions);
          if (rest.norm() > 1e-3 * neighbourhood)
            {
              result.motion = motion(rest);
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
    part_of_cell.assign(mesh.n_cells(0), numbers::invalid_unsigned_int);
    unsigned int                                            n_parts = 0;
    std::vector<typename Triangulation<dim>::cell_iterator> front;
    for (const auto &first : mesh.cell_iterators_on_level(0))
      if (part_of_cell[first->index()] == numbers::invalid_unsigned_int)
        {
          part_of_cell[first->index()] = n_parts;
          front.push_back(first);
          while (!front.empty())
            {
              const auto cell = front.back();
              front.pop_back();
              for (const unsigned int f : cell->face_indices())
                if (!cell->at_boundary(f))
                  {
                    const auto    neighbor = cell->neighbor(f);
                    unsigned int &part     = part_of_cell[neighbor->index()];
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



  template <int dim>
  Eigen::MatrixXd
  FreePart<dim>::displacements_at(const Point<dim> &p) const
  {
    return all_motions_at(*this, p) * motions;
  }



  namespace
  {
    // The vertices in which several parts meet.
    template <int dim>
    void
    find_joints(const Triangulation<dim>        &mesh,
                const std::vector<unsigned int> &part_of_cell,
                std::vector<FreePart<dim>>      &parts)
    {
      std::vector<unsigned int> part_of_vertex(mesh.n_vertices(),
                                               numbers::invalid_unsigned_int);
      std::set<unsigned int>    joints;
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (const unsigned int v : cell->vertex_indices())
          {
            unsigned int &part = part_of_vertex[cell->vertex_index(v)];
            if (part == numbers::invalid_unsigned_int)
              part = part_of_cell[cell->index()];
            else if (part != part_of_cell[cell->index()])
              joints.insert(cell->vertex_index(v));
          }
      std::set<std::pair<unsigned int, unsigned int>> seen;
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (const unsigned int v : cell->vertex_indices())
          if (const unsigned int number = part_of_cell[cell->index()];
              joints.count(cell->vertex_index(v)) > 0 &&
              seen.insert({number, cell->vertex_index(v)}).second)
            {
              ++parts[number].n_joints;
              parts[number].joint = cell->vertex(v);
            }
    }



    // Whether the part has a boundary that may touch an obstacle, with friction
    // if that is asked for.
    template <int dim>
    bool
    has_contact(const Scene<dim>    &scene,
                const FreePart<dim> &part,
                const bool           with_friction = false)
    {
      const auto &conditions = scene.contact_conditions();
      return std::any_of(
        conditions.begin(), conditions.end(), [&](const auto &condition) {
          return part.boundary_ids.count(condition.boundary_id) > 0 &&
            !condition.obstacle.empty() &&
            (!with_friction || condition.friction_law != FrictionLaw::none);
        });
    }



    // Whether the part has a boundary of which the force is given.
    template <int dim>
    bool
    has_platen(const Scene<dim> &scene, const FreePart<dim> &part)
    {
      const auto &conditions = scene.dirichlet_conditions();
      return std::any_of(
        conditions.begin(), conditions.end(), [&](const auto &condition) {
          return condition.platen != nullptr &&
            part.boundary_ids.count(condition.boundary_id) > 0;
        });
    }



    // Eigenvectors of the equations for the motions of a part, those of the
    // motions that they leave free first, and how many of these there are.
    template <int dim>
    std::pair<unsigned int, Eigen::MatrixXd>
    free_motions(const Eigen::MatrixXd &equations)
    {
      const auto [values, vectors] = eigenpairs(equations);
      unsigned int n_free          = 0;
      while (n_free < n_motions<dim> &&
             values[n_free] <= 1e-10 * std::max(1., values[n_motions<dim> - 1]))
        ++n_free;
      return {n_free, vectors};
    }



    // Parts that are known to resist make the platens that they share with
    // others resist, and those the others.
    template <int dim>
    void
    hand_on_by_platens(const Scene<dim>                 &scene,
                       const std::vector<FreePart<dim>> &parts,
                       std::vector<bool>                &resists)
    {
      for (bool changes = true; changes;)
        {
          changes = false;
          for (const auto &condition : scene.dirichlet_conditions())
            {
              bool is_held = false;
              for (unsigned int i = 0; i < parts.size(); ++i)
                is_held = is_held ||
                  (condition.platen != nullptr && resists[i] &&
                   parts[i].boundary_ids.count(condition.boundary_id) > 0);
              for (unsigned int i = 0; is_held && i < parts.size(); ++i)
                if (!resists[i] &&
                    parts[i].boundary_ids.count(condition.boundary_id) > 0)
                  {
                    resists[i] = true;
                    changes    = true;
                  }
            }
        }
    }
  } // namespace



  template <int dim>
  std::vector<FreePart<dim>>
  free_parts(const Scene<dim>          &scene,
             const Triangulation<dim>  &mesh,
             std::vector<unsigned int> &part_of_cell)
  {
    std::vector<FreePart<dim>> parts(find_parts(mesh, part_of_cell));
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      {
        FreePart<dim> &part = parts[part_of_cell[cell->index()]];
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double x     = cell->vertex(v)[d];
              const bool   first = part.n_cells == 0 && v == 0;
              part.lower[d]      = first ? x : std::min(part.lower[d], x);
              part.upper[d]      = first ? x : std::max(part.upper[d], x);
            }
        ++part.n_cells;
        part.materials.insert(cell->material_id());
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            part.boundary_ids.insert(face->boundary_id());
      }

    if (parts.size() > 1)
      find_joints(mesh, part_of_cell, parts);

    // Each component that is prescribed in a vertex is an equation for the
    // motions: those of the part that hold it in any case, and for components
    // that a platen controls those that hold if the platen is held, and those
    // that say no more than that it does not turn.
    std::vector<Eigen::MatrixXd> equations(
      parts.size(), Eigen::MatrixXd::Zero(n_motions<dim>, n_motions<dim>));
    std::vector<Eigen::MatrixXd> of_held_platens = equations,
                                 of_free_platens = equations;
    // Of each part and condition a vertex, from which others are counted.
    std::map<std::pair<unsigned int, const void *>, Point<dim>> first_vertices;
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      {
        const unsigned int number = part_of_cell[cell->index()];
        const auto         row_of = [&](const Point<dim>  &p,
                                const unsigned int component) {
          return Eigen::VectorXd(
            all_motions_at(parts[number], p).row(component).transpose());
        };
        const auto prescribe = [&](std::vector<Eigen::MatrixXd> &where,
                                   const Eigen::VectorXd        &row) {
          where[number] += row * row.transpose();
        };
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            for (const auto &condition : scene.dirichlet_conditions())
              if (face->boundary_id() == condition.boundary_id)
                for (const unsigned int v : face->vertex_indices())
                  {
                    const Point<dim> p = face->vertex(v);
                    const Point<dim> first =
                      first_vertices.insert({{number, &condition}, p})
                        .first->second;
                    for (unsigned int d = 0; d < dim; ++d)
                      if (condition.components[d] &&
                          condition.platen != nullptr &&
                          condition.platen->is_controlled[d])
                        {
                          prescribe(of_held_platens, row_of(p, d));
                          prescribe(of_free_platens,
                                    row_of(p, d) - row_of(first, d));
                        }
                      else if (condition.components[d])
                        prescribe(equations, row_of(p, d));
                  }
        scene.for_each_pin(
          cell, [&](const PinnedPoint<dim> &pin, unsigned int) {
            prescribe(equations, row_of(pin.point, pin.component));
          });
      }

    // A platen is held by a part that touches an obstacle, or that is held
    // without it; whether that bears the given force is found out by looking
    // for it, see ForceControl.
    std::vector<bool> resists(parts.size());
    for (unsigned int number = 0; number < parts.size(); ++number)
      resists[number] = has_contact(scene, parts[number]) ||
        free_motions<dim>(equations[number]).first == 0;
    hand_on_by_platens(scene, parts, resists);

    std::vector<FreePart<dim>> result;
    for (unsigned int number = 0; number < parts.size(); ++number)
      {
        const auto [n_free, directions] = free_motions<dim>(
          equations[number] +
          (resists[number] ? of_held_platens : of_free_platens)[number]);
        if (n_free == 0)
          continue;
        FreePart<dim> &part = parts[number];
        part.number         = number;
        part.n_all_cells    = mesh.n_cells(0);
        part.motions        = simple_basis(directions.leftCols(n_free));
        result.push_back(part);
      }
    return result;
  }



  namespace
  {
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
  std::string
  not_held(const Scene<dim>                                   &scene,
           const FreePart<dim>                                &part,
           const Holding                                      &holding,
           const std::function<bool(const Eigen::VectorXd &)> &is_stopped)
  {
    // Several free motions are listed, if nothing but displacements could stop
    // them; one that contact leaves is described as it is.
    std::string  what;
    unsigned int n_listed = 0;
    if (!holding.is_driven)
      for (unsigned int i = 0; i < part.motions.cols(); ++i)
        if (!is_stopped(Eigen::VectorXd::Unit(part.motions.cols(), i)))
          {
            what += (what.empty() ? "" : " and ") +
              describe_motion<dim>(part.motions.col(i), part);
            ++n_listed;
          }
    if (dim == 3 && n_listed == n_motions<dim>)
      what = "a displacement in any direction and a rotation around any axis";
    if (what.empty())
      what = describe_motion<dim>(part.motions * holding.motion, part);

    std::ostringstream name;
    if (part.n_cells == part.n_all_cells)
      name << "the body";
    else
      {
        name << "the part of the body in "
             << describe<dim>(part.lower, size(part)) << " to "
             << describe<dim>(part.upper, size(part)) << " (" << part.n_cells
             << " of " << part.n_all_cells << " coarse cells, which share ";
        if (part.n_joints > 0)
          name << counted(part.n_joints, "vertex", "vertices")
               << " with the others, "
               << (part.n_joints == 1 ? "" : "one of them ")
               << describe<dim>(part.joint, size(part))
               << ", but parts are joined by " << (dim == 2 ? "edges" : "faces")
               << " only";
        else
          name << "no " << (dim == 2 ? "edge" : "face") << " with the others";
        if (part.materials.size() > 1 || *part.materials.begin() > 0)
          name << ", physical id " << list(part.materials);
        name << ")";
      }
    return name.str() + " is not held against " + what + ": " +
      (holding.is_driven ? "its loads push it there, and " : "") +
      "neither a displacement " +
      (has_contact(scene, part) ? std::string("nor contact stops it") +
           (has_contact(scene, part, /*with friction*/ true)
              ? " (friction may resist sliding, but is not relied on here)"
              : "")
                                : "nor an obstacle stops it") +
      (has_platen(scene, part) ? ", and a boundary with a given force does not"
                               : "") +
      "; prescribe a displacement on one of its boundaries (" +
      list(part.boundary_ids) +
      ") in 'Boundary conditions/Displacement', or of a vertex in 'Boundary "
      "conditions/Pinned points'" +
      (scene.n_load_steps() > 1 && has_contact(scene, part)
         ? ", or let there be loads that press it against an obstacle at each "
           "of the 'Load steps/Times'."
         : ".");
  }



  template <int dim>
  void
  check_that_body_can_be_held(const Scene<dim>         &scene,
                              const Triangulation<dim> &mesh,
                              const std::string        &where)
  {
    std::vector<unsigned int> part_of_cell;
    for (const FreePart<dim> &part : free_parts(scene, mesh, part_of_cell))
      if (!has_contact(scene, part))
        {
          Holding holding;
          holding.motion = Eigen::VectorXd::Unit(part.motions.cols(), 0);
          throw InputError(
            where +
            not_held<dim>(scene, part, holding, [](const Eigen::VectorXd &) {
              return false;
            }));
        }
  }



  template unsigned int find_parts(const Triangulation<2> &,
                                   std::vector<unsigned int> &);
  template unsigned int find_parts(const Triangulation<3> &,
                                   std::vector<unsigned int> &);
  template struct FreePart<2>;
  template struct FreePart<3>;
  template std::vector<FreePart<2>> free_parts(const Scene<2> &,
                                               const Triangulation<2> &,
                                               std::vector<unsigned int> &);
  template std::vector<FreePart<3>> free_parts(const Scene<3> &,
                                               const Triangulation<3> &,
                                               std::vector<unsigned int> &);
  template std::string
  not_held(const Scene<2> &,
           const FreePart<2> &,
           const Holding &,
           const std::function<bool(const Eigen::VectorXd &)> &);
  template std::string
                not_held(const Scene<3> &,
                         const FreePart<3> &,
                         const Holding &,
                         const std::function<bool(const Eigen::VectorXd &)> &);
  template void check_that_body_can_be_held(const Scene<2> &,
                                            const Triangulation<2> &,
                                            const std::string &);
  template void check_that_body_can_be_held(const Scene<3> &,
                                            const Triangulation<3> &,
                                            const std::string &);
} // namespace Friction
