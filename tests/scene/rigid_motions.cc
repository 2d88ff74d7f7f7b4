// Whether a body is held.
//
// - Parts of a body: cells that share a face belong together, those that share
//   a vertex or an edge only do not.
// - The vector of a cone that is nearest to another one: the rest is
//   perpendicular to it, and to no ray of the cone under an acute angle.
// - held_by_contact() on random problems in one to three unknown motions. If it
//   finds a motion, nothing stops it, and loads do work on it; if it finds
//   none, some pressures, of as many nodes as there are motions, balance the
//   loads, which is tried for all sets of nodes. Both cannot be.
// - Bodies that are held by a boundary, by two planes of symmetry, by three
//   components in two vertices, and with one of these less. What is pinned in a
//   vertex of the coarse mesh, up to rounding, is pinned on fine ones.
// - Columns side by side with platens of given force on them: these hold if
// some
//   column is held otherwise, and hand that on to all columns that they share.

#include <common/input_error.h>
#include <common/scene/rigid_motions.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <random>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/test.h>

using namespace Friction;
using namespace Tests;

namespace test_rigid_motions
{
  template <int dim>
  unsigned int
  n_parts(const Triangulation<dim> &mesh)
  {
    std::vector<unsigned int> parts;
    return find_parts(mesh, parts);
  }



  // A cube, and another one that is shifted by so many edge lengths.
  template <int dim>
  unsigned int
  n_parts_of_two(const Point<dim> &shift)
  {
    Triangulation<dim> one, other, both;
    GridGenerator::hyper_cube(one);
    GridGenerator::hyper_cube(other);
    GridTools::shift(shift, other);
    GridGenerator::merge_triangulations(one, other, both);
    return n_parts(both);
  }



  void
  test_parts()
  {
    Triangulation<2> mesh;
    GridGenerator::hyper_L(mesh);
    mesh.refine_global(2);
    check(n_parts(mesh) == 1, "one part");
    check(n_parts_of_two(Point<2>(1., 0.)) == 1, "joined by an edge, 2D");
    check(n_parts_of_two(Point<2>(1., 1.)) == 2, "joined by a vertex, 2D");
    check(n_parts_of_two(Point<2>(2., 0.)) == 2, "apart, 2D");
    check(n_parts_of_two(Point<3>(0., 0., 1.)) == 1, "joined by a face, 3D");
    check(n_parts_of_two(Point<3>(0., 1., 1.)) == 2, "joined by an edge, 3D");
    check(n_parts_of_two(Point<3>(1., 1., 1.)) == 2, "joined by a vertex, 3D");
  }



  // Whether pressures of some nodes, at most as many as there are motions,
  // balance the loads: by trying all of them.
  bool
  some_pressures_balance(const Eigen::VectorXd     &loads,
                         const Eigen::MatrixXd     &contact,
                         std::vector<unsigned int> &nodes,
                         const unsigned int         first)
  {
    if (!nodes.empty())
      {
        Eigen::MatrixXd columns(contact.rows(), nodes.size());
        for (unsigned int i = 0; i < nodes.size(); ++i)
          columns.col(i) = contact.col(nodes[i]);
        const Eigen::VectorXd pressures = Tests::least_squares(columns, loads);
        if (pressures.minCoeff() >= -1e-9 &&
            (columns * pressures - loads).norm() < 1e-9 * loads.norm())
          return true;
      }
    if (nodes.size() == static_cast<std::size_t>(contact.rows()))
      return false;
    for (unsigned int p = first; p < contact.cols(); ++p)
      {
        nodes.push_back(p);
        const bool found = some_pressures_balance(loads, contact, nodes, p + 1);
        nodes.pop_back();
        if (found)
          return true;
      }
    return false;
  }



  void
  test_contact()
  {
    std::mt19937 generator(7);
    const auto   random = [&]() {
      return 2. * generator() / generator.max() - 1.;
    };
    unsigned int n_held = 0, n_driven = 0, n_wrong = 0;
    for (unsigned int problem = 0; problem < 3000; ++problem)
      {
        const unsigned int n_motions = 1 + problem % 3;
        const unsigned int n_nodes   = generator() % 7;
        Eigen::VectorXd    loads(n_motions);
        Eigen::MatrixXd    contact(n_motions, n_nodes);
        for (unsigned int i = 0; i < n_motions; ++i)
          {
            loads[i] = random();
            for (unsigned int p = 0; p < n_nodes; ++p)
              contact(i, p) = random();
          }
        const Holding             holding = held_by_contact(loads, contact);
        std::vector<unsigned int> nodes;
        const bool balanced = some_pressures_balance(loads, contact, nodes, 0);
        if (holding.is_driven)
          {
            ++n_driven;
            const bool nothing_stops = n_nodes == 0 ||
              (contact.transpose() * holding.motion).maxCoeff() < 1e-6;
            n_wrong +=
              balanced || !nothing_stops || !(holding.motion.dot(loads) > 0.);
          }
        else
          {
            n_held += holding.motion.size() == 0;
            n_wrong += !balanced;
          }
      }
    check(n_wrong == 0, "held or not, as all sets of nodes say");
    check(n_held > 300 && n_driven > 300, "both of them often");

    // A block on a plane without friction: from its two lower corners. It may
    // move in x direction, be lifted, and be turned.
    Eigen::MatrixXd corners(2, 2);
    corners << 1., 1., -.5, .5;
    Eigen::VectorXd load(2);
    load << 1., 0.;
    check(held_by_contact(load, corners).motion.size() == 0,
          "a block on its two corners is held by its weight");
    load << 1., .4;
    check(held_by_contact(load, corners).motion.size() == 0,
          "and also if that is nearer to one of them");
    load << 1., .5;
    check(held_by_contact(load, corners).motion.size() == 2 &&
            !held_by_contact(load, corners).is_driven,
          "above a corner it can be turned without work");
    load << 1., .6;
    check(held_by_contact(load, corners).is_driven, "and beyond it tips over");
    load << 0., 0.;
    check(held_by_contact(load, corners).motion.size() == 2,
          "without any weight it can be lifted");
    Eigen::MatrixXd walls(1, 2);
    walls << 1., -1.;
    check(held_by_contact(Eigen::VectorXd::Zero(1), walls).motion.size() == 0,
          "between two walls nothing moves, without any load");
  }



  void
  test_cones()
  {
    std::mt19937 generator(11);
    const auto   random = [&]() {
      return 2. * generator() / generator.max() - 1.;
    };
    double       largest_cosine = 0., largest_product = 0.;
    unsigned int n_inside = 0, n_apex = 0, n_sides = 0;
    for (unsigned int problem = 0; problem < 3000; ++problem)
      {
        const unsigned int dim = 2 + problem % 2, n_rays = problem % 5;
        Eigen::VectorXd    v(dim);
        Eigen::MatrixXd    rays(dim, n_rays);
        for (unsigned int d = 0; d < dim; ++d)
          {
            v[d] = random();
            for (unsigned int i = 0; i < n_rays; ++i)
              rays(d, i) = random();
          }
        const Eigen::VectorXd nearest = nearest_in_cone(v, rays);
        const Eigen::VectorXd rest    = v - nearest;
        largest_product =
          std::max(largest_product, std::abs(rest.dot(nearest)));
        for (unsigned int i = 0; i < n_rays; ++i)
          largest_cosine = std::max(largest_cosine, rest.dot(rays.col(i)));
        (rest.norm() < 1e-9        ? n_inside
           : nearest.norm() < 1e-9 ? n_apex
                                   : n_sides) += 1;
      }
    check(largest_product < 1e-8 && largest_cosine < 1e-8,
          "what is nearest in a cone");
    check(n_inside > 100 && n_apex > 100 && n_sides > 100,
          "inside, at the apex, and on the sides of it");
  }



  void
  test_pins()
  {
    // Two thirds with nine digits; the finest cells are a thousand times as
    // long as the error.
    Parameters p;
    p.scene.size                        = {2. / 3., 1.};
    p.scene.subdivisions                = {1, 1};
    p.boundary_conditions.pinned_points = {{"(0.666666668, 0)", {"0", "0"}},
                                           {"(0, 0)", {"free", "0"}}};
    const Scene<2>   scene(p);
    Triangulation<2> mesh;
    scene.make_coarse_mesh(mesh);
    for (unsigned int level = 0; level < 10; ++level)
      {
        for (auto &cell : mesh.active_cell_iterators())
          if (cell->center().distance(Point<2>(2. / 3., 0.)) < cell->diameter())
            cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
      }
    unsigned int n_found = 0, n_second = 0;
    for (const auto &cell : mesh.active_cell_iterators())
      scene.for_each_pin(cell,
                         [&](const PinnedPoint<2> &pin, const unsigned int v) {
                           ++n_found;
                           n_second += pin.component == 1;
                           if (cell->vertex(v).distance(pin.point) > 1e-8)
                             n_found = 100;
                         });
    check(n_found == 3 && n_second == 2,
          "pinned on a fine mesh as on a coarse");
  }



  // What the scene has to say of its mesh, up to a colon that ends the motions.
  template <int dim>
  std::string
  verdict(const Parameters &p)
  {
    Triangulation<dim> mesh;
    try
      {
        Scene<dim>(p).make_coarse_mesh(mesh);
      }
    catch (const InputError &error)
      {
        const std::string text  = error.what();
        const std::string begin = "is not held against ";
        const auto        first = text.find(begin);
        return first == std::string::npos
          ? text
          : text.substr(first + begin.size(),
                        text.find(": n", first) - first - begin.size());
      }
    return "held";
  }



  void
  test_bodies()
  {
    Parameters p;
    p.scene.size         = {2., 1.};
    p.scene.subdivisions = {2, 1};
    auto &displacement   = p.boundary_conditions.displacement;
    auto &pins           = p.boundary_conditions.pinned_points;
    displacement         = {{"3", {"0", "0"}}};
    check(verdict<2>(p) == "held", "held by a boundary");
    displacement = {{"0", {"0", "free"}}, {"2", {"free", "0"}}};
    check(verdict<2>(p) == "held", "held by two planes of symmetry");
    displacement = {{"0", {"0", "free"}}};
    check(verdict<2>(p) == "a displacement in y direction",
          "one of them leaves a displacement");
    displacement.clear();
    pins = {{"(0, 0)", {"0", "0"}}, {"(2, 0)", {"free", "0"}}};
    check(verdict<2>(p) == "held", "held by three components of two vertices");
    pins.pop_back();
    check(verdict<2>(p) == "a rotation around (0, 0)", "one vertex is a hinge");
    pins = {{"(0, 0)", {"0", "0"}}, {"(2, 0)", {"0", "free"}}};
    check(verdict<2>(p) == "a rotation around (0, 0)",
          "two that are held along their line, too");
    pins.clear();
    check(verdict<2>(p) ==
            "a displacement in x direction and a displacement in y direction "
            "and a rotation around (1, 0.5)",
          "nothing holds it");

    p.scene.size         = {2., 1., 1.};
    p.scene.subdivisions = {2, 1, 1};
    pins = {{"(0, 0, 0)", {"0", "0", "0"}}, {"(2, 0, 0)", {"free", "0", "0"}}};
    check(verdict<3>(p) ==
            "a rotation around the axis through (1, 0, 0) in x direction",
          "two vertices are an axis");
    pins.push_back({"(0, 1, 0)", {"free", "free", "0"}});
    check(verdict<3>(p) == "held", "and three vertices hold");
  }



  // Squares side by side and apart, their tops and bottoms with these boundary
  // ids: how many of them may move.
  unsigned int
  n_free_columns(const Parameters                &p,
                 const std::vector<unsigned int> &tops,
                 const std::vector<unsigned int> &bottoms)
  {
    std::vector<Triangulation<2>>         columns(tops.size());
    std::vector<const Triangulation<2> *> all;
    for (unsigned int i = 0; i < tops.size(); ++i)
      {
        GridGenerator::hyper_cube(columns[i]);
        GridTools::shift(Point<2>(2. * i, 0.), columns[i]);
        all.push_back(&columns[i]);
      }
    Triangulation<2> mesh;
    GridGenerator::merge_triangulations(all, mesh);
    for (const auto &cell : mesh.active_cell_iterators())
      {
        const unsigned int i = std::lround((cell->center()[0] - .5) / 2.);
        cell->face(2)->set_boundary_id(bottoms[i]);
        cell->face(3)->set_boundary_id(tops[i]);
      }
    std::vector<unsigned int> parts;
    return free_parts(Scene<2>(p), mesh, parts).size();
  }



  void
  test_platens()
  {
    Parameters p;
    auto      &displacement = p.boundary_conditions.displacement;
    auto      &force        = p.boundary_conditions.force;
    displacement            = {{"3", {"0", "-0.01"}}};
    force                   = {{"3", {"free", "-0.02"}}};
    check(n_free_columns(p, {3}, {0}) == 1, "a platen does not hold a column");
    check(n_free_columns(p, {3, 3}, {0, 0}) == 2, "nor two of them");
    displacement.push_back({"2", {"0", "0"}});
    check(n_free_columns(p, {3, 3}, {2, 0}) == 0,
          "it does if one of them stands on something");
    displacement.push_back({"1", {"0", "-0.01"}});
    force.push_back({"1", {"free", "-0.01"}});
    check(n_free_columns(p, {3, 3, 0}, {2, 1, 1}) == 0,
          "and hands that on to another platen");
    check(n_free_columns(p, {3, 0, 0}, {2, 1, 1}) == 2,
          "which it has to share a column with");
  }
} // namespace test_rigid_motions



TEST(rigid_motions)
{
  test_parts();
  test_contact();
  test_cones();
  test_bodies();
  test_pins();
  test_platens();
}
