// Relaxation by planes, on the matrix of a block whose cells are four times as
// long as wide in one direction, on a uniform mesh and with hanging nodes, with
// a truncation picked at random for the contact nodes:
//
// - on cubes, and where cells are twice as long as wide, there are no planes;
//   on stretched cells each plane is one of vertices across the long direction,
//   and they cover the mesh, but for contact nodes where these fill a plane;
// - the sweep over a single plane solves its problem: afterwards its residual
//   vanishes;
// - values and residual stay truncated, and the residual is that of
//   $T(A+\omega'')T$;
// - each sweep lowers the energy, on several processes as well;
// - a truncation that changes gives what it gives from the beginning, and so
//   does a matrix that changes, in which a direction may have vanished at a
//   node;
// - components that are held keep their values, and the energy falls;
// - where there are lines, too, both are relaxed, and all of this is true.

#include <common/nodes/relaxed_together.h>
#include <common/nodes/stretched_relaxation.h>

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <set>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/random.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>
#include <tests/support/truncated_values.h>

using namespace Tests;

namespace test_plane_relaxation
{
  constexpr unsigned int dim = 3;

  Parameters
  block(const unsigned int long_direction, const unsigned int ratio)
  {
    Parameters p       = block_parameters<dim>(FrictionLaw::none, 0.);
    p.scene.distortion = 0.;
    p.scene.size.assign(dim, 1.);
    p.scene.subdivisions.assign(dim, 2 * ratio);
    p.scene.subdivisions[long_direction] = 2;
    return p;
  }



  // Some contact nodes stick, others slide, with or without a second
  // derivative, and others are free.
  Truncation<dim>
  random_truncation(const Discretization<dim> &d, Random &random)
  {
    Truncation<dim> truncation(d.constraints());
    for (const ContactNode<dim> &p : d.contact())
      if (d.constraints().is_free(p.node) && random.chance(.6))
        {
          NodeBlock<dim> projector = identity_block<dim>(),
                         curvature = zero_block<dim>();
          projector[0]             = 0.;
          if (random.chance(.5))
            projector = zero_block<dim>();
          else if (random.chance(.5))
            curvature[dim * dim - 1] = 3.;
          truncation.set(p.node, projector, curvature);
        }
    return truncation;
  }



  RelaxedNodes
  nodes_of(const Discretization<dim> &d)
  {
    RelaxedNodes nodes;
    nodes.nodes   = movable_nodes(d);
    nodes.is_held = [&d](const unsigned int i, const unsigned int c) {
      return d.constraints().is_prescribed(i, c);
    };
    for (const ContactNode<dim> &p : d.contact())
      nodes.truncated.push_back(p.node);
    nodes.positions = [&d]() {
      Places positions;
      for (const Point<dim> &point : node_points(d))
        positions.push_back(place_of(point));
      positions.resize(d.constraints().n_owned_nodes());
      return positions;
    };
    return nodes;
  }



  void
  test_none(const unsigned int ratio)
  {
    const Scene<dim> scene(block(0, ratio));
    const auto       mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(1);
    const Discretized<dim>     d(scene, *mesh);
    const PlaneRelaxation<dim> relaxation(
      d.stiffness().blocks(), nodes_of(d), MPI_COMM_WORLD);
    check_everywhere(relaxation.share_of_nodes() == 0., "there are none");
  }



  void
  test(const unsigned int direction, const bool hanging_nodes)
  {
    const Scene<dim> scene(block(direction, 4));
    const auto       mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(1);
    if (hanging_nodes)
      {
        for (const auto &cell : mesh->active_cell_iterators())
          if (cell->is_locally_owned() && cell->center()[0] < .5 &&
              cell->center()[dim - 1] < .5)
            cell->set_refine_flag();
        mesh->execute_coarsening_and_refinement();
      }
    Discretized<dim>            d(scene, *mesh);
    const NodeBlockMatrix<dim> &A = d.stiffness().blocks();
    PlaneRelaxation<dim>        relaxation(A, nodes_of(d), MPI_COMM_WORLD);
    check_everywhere(relaxation.share_of_nodes() > (direction == dim - 1 ? .45
                                                      : hanging_nodes    ? .5
                                                                         : .6),
                     "there are planes, and they cover the mesh");

    const bool alone  = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
    const auto points = node_points(d);
    bool       flat   = true;
    std::set<unsigned int> covered, contact;
    for (const std::vector<unsigned int> &plane : relaxation.planes())
      for (const unsigned int i : plane)
        {
          covered.insert(i);
          flat = flat &&
            std::abs(points[i][direction] - points[plane[0]][direction]) <
              1e-12;
        }
    check_everywhere(flat, "across the long direction");
    for (const ContactNode<dim> &p : d.contact())
      contact.insert(p.node);
    unsigned int n_contact = 0, n_others = 0;
    for (const unsigned int i : covered)
      n_contact += contact.count(i);
    for (const RowRange &range : relaxation.other_nodes(movable_nodes(d)))
      for (unsigned int i = range.first; i < range.second; ++i)
        n_others += 1 - covered.count(i);
    unsigned int n_movable = 0;
    for (const RowRange &range : movable_nodes(d))
      n_movable += range.second - range.first;
    check_everywhere(covered.size() + n_others == n_movable,
                     "what is in no plane are the other nodes");
    if (alone)
      check((n_contact > 0) == (direction != dim - 1),
            direction == dim - 1 ? "contact nodes are left out"
                                 : "contact nodes are in them");

    Random          random(3);
    Truncation<dim> truncation = random_truncation(d, random);
    relaxation.factorise(&truncation);
    truncation = random_truncation(d, random);
    relaxation.factorise(&truncation);
    const auto random_vector = [&]() {
      return random_truncated(d, truncation, random);
    };
    // What the matrix is: T (A + w) x for truncated x.
    const auto apply = [&](const VectorType &x) {
      return truncated_product(d, truncation, x);
    };
    const VectorType b      = random_vector();
    const auto       energy = [&](const VectorType &x) {
      return .5 * (x * apply(x)) - b * x;
    };
    GhostExchange &ghosts = d.stiffness().ghosts();

    VectorType       x = random_vector(), residual = d.vector();
    const VectorType x_start = x;
    double           last    = energy(x);
    bool             falls = true, residual_is_right = true, stays = true;
    for (unsigned int sweep = 0; sweep < 6; ++sweep)
      {
        d.stiffness().update_ghosts(x);
        relaxation.run(1, b.begin(), x.begin(), ghosts, residual.begin());
        const double now      = energy(x);
        falls                 = falls && now < last;
        last                  = now;
        VectorType difference = apply(x);
        difference -= b;
        difference += residual;
        for (unsigned int i = 0; i < A.n_rows(); ++i)
          if (d.constraints().is_fixed(i))
            for (unsigned int c = 0; c < dim; ++c)
              difference.local_element(dim * i + c) = 0.;
        residual_is_right =
          residual_is_right && difference.linfty_norm() < 1e-11;
        difference = x;
        truncation.apply(difference.begin());
        difference -= x;
        stays = stays && difference.linfty_norm() < 1e-14;
      }
    check_everywhere(falls, "each sweep lowers the energy");
    check_everywhere(residual_is_right, "the residual is the truncated one");
    check_everywhere(stays, "values stay truncated");

    // The plane that a sweep comes to last.
    if (alone)
      {
        const std::vector<unsigned int> relaxed_last =
          relaxation.planes().back();
        double left = 0;
        for (const unsigned int node : relaxed_last)
          for (unsigned int c = 0; c < dim; ++c)
            left =
              std::max(left, std::abs(residual.local_element(dim * node + c)));
        check_below(left / residual.linfty_norm(),
                    1e-10,
                    "what is left on the plane relaxed last");
      }

    PlaneRelaxation<dim> fresh(A, nodes_of(d), MPI_COMM_WORLD);
    fresh.factorise(&truncation);
    VectorType v = x_start, w = x_start;
    d.stiffness().update_ghosts(v);
    d.stiffness().update_ghosts(w);
    relaxation.run(1, b.begin(), v.begin(), ghosts);
    fresh.run(1, b.begin(), w.begin(), ghosts);
    v -= w;
    check_everywhere(v.linfty_norm() < 1e-12 * w.linfty_norm(),
                     "a truncation that has changed is as good as a new one");

    // Without truncation, but with components that are held, and a matrix that
    // changes: on levels. A row and a column of it vanish.
    NodeBlockMatrix<dim> B       = A;
    RelaxedNodes         holding = nodes_of(d);
    holding.truncated.clear();
    holding.is_held = [](const unsigned int i, const unsigned int component) {
      return i % 3 == component;
    };
    PlaneRelaxation<dim> of_level(B, holding, MPI_COMM_WORLD);
    of_level.factorise();
    const unsigned int gone =
      covered.empty() ? numbers::invalid_unsigned_int : *covered.begin();
    const unsigned int lost = (gone + 1) % dim;
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      for (std::size_t e = B.row_begin(i); e < B.stored_end(i); ++e)
        {
          NodeBlock<dim> block = B.value(i, e);
          for (unsigned int k = 0; k < dim; ++k)
            {
              if (i == gone)
                block[k * dim + lost] = 0.;
              if (B.column(e) == gone)
                block[lost * dim + k] = 0.;
            }
          B.set(i, e, block);
        }
    of_level.factorise();
    const Truncation<dim> none(d.constraints());
    VectorType            rhs = b, y = random_vector();
    if (!covered.empty())
      rhs.local_element(dim * gone + lost) = 0.;
    none.apply(y.begin());
    d.stiffness().update_ghosts(y);
    const VectorType start          = y;
    const auto       energy_without = [&](const VectorType &u) {
      VectorType Bu = d.vector();
      d.stiffness().update_ghosts(u);
      B.vmult(Bu.begin(), u.begin());
      return .5 * (u * Bu) - rhs * u;
    };
    of_level.run(1, rhs.begin(), y.begin(), ghosts, residual.begin());
    bool   holds = true, moves = false;
    double left = 0.;
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      for (unsigned int k = 0; k < dim; ++k)
        {
          const double change =
            y.local_element(dim * i + k) - start.local_element(dim * i + k);
          if (holding.is_held(i, k) || (i == gone && k == lost))
            holds = holds && std::abs(change) < 1e-12;
          else
            moves = moves || change != 0.;
        }
    check_everywhere(holds && (moves || covered.empty()),
                     "what is held, or has no energy, keeps its value");
    if (alone)
      {
        const std::vector<unsigned int> relaxed_last = of_level.planes().back();
        for (const unsigned int i : relaxed_last)
          for (unsigned int k = 0; k < dim; ++k)
            if (!holding.is_held(i, k))
              left =
                std::max(left, std::abs(residual.local_element(dim * i + k)));
        check_below(left / residual.linfty_norm(),
                    1e-10,
                    "what is left on the plane relaxed last");
        check(energy_without(y) < energy_without(start), "the energy falls");
      }

    PlaneRelaxation<dim> fresh_of_level(A, holding, MPI_COMM_WORLD);
    fresh_of_level.factorise();
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      for (std::size_t e = B.row_begin(i); e < B.stored_end(i); ++e)
        B.set(i, e, A.value(i, e));
    of_level.factorise();
    v = start;
    w = start;
    d.stiffness().update_ghosts(v);
    d.stiffness().update_ghosts(w);
    of_level.run(1, b.begin(), v.begin(), ghosts);
    fresh_of_level.run(1, b.begin(), w.begin(), ghosts);
    v -= w;
    check_everywhere(v.linfty_norm() < 1e-12 * w.linfty_norm(),
                     "a matrix that has changed is as good as a new one");
  }



  // Long cells, of which those in the lower half are also flat: lines there,
  // and planes above.
  void
  test_lines_and_planes()
  {
    const Scene<dim> scene(block(0, 4));
    const auto       mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(1);
    GridTools::transform(
      [](const Point<dim> &p) {
        Point<dim> q = p;
        q[dim - 1]   = p[dim - 1] < .5 ? .1 * p[dim - 1] : p[dim - 1] - .45;
        return q;
      },
      *mesh);
    Discretized<dim>            d(scene, *mesh);
    const NodeBlockMatrix<dim> &A = d.stiffness().blocks();
    StretchedRelaxation<dim>    both(A, nodes_of(d), MPI_COMM_WORLD);
    check_everywhere(both.share_in_lines() > .1 &&
                       both.share() > both.share_in_lines() + .1 &&
                       both.share() <= 1.,
                     "there are both");
    unsigned int n_left = 0, n_all = 0;
    for (const RowRange &range : both.other_nodes(movable_nodes(d)))
      n_left += range.second - range.first;
    for (const RowRange &range : movable_nodes(d))
      n_all += range.second - range.first;
    n_left = Utilities::MPI::sum(n_left, MPI_COMM_WORLD);
    n_all  = Utilities::MPI::sum(n_all, MPI_COMM_WORLD);
    check_everywhere(std::abs(1. - both.share() - double(n_left) / n_all) <
                       1e-12,
                     "their share is that of all but the other nodes");

    Random                random(5);
    const Truncation<dim> truncation = random_truncation(d, random);
    both.factorise(&truncation);
    const auto random_vector = [&]() {
      VectorType v = random_truncated(d, truncation, random);
      d.stiffness().update_ghosts(v);
      return v;
    };
    const VectorType b        = random_vector();
    GhostExchange   &ghosts   = d.stiffness().ghosts();
    bool             is_right = true;
    VectorType       x = random_vector(), residual = d.vector();
    residual = 7.;
    both.run(2, b.begin(), x.begin(), ghosts, residual.begin());
    for (const RowRange &range : movable_nodes(d))
      for (unsigned int i = range.first; i < range.second; ++i)
        {
          const NodeValue<dim> r = RelaxedTogether::residual<dim>(
            A, &truncation, i, b.begin(), x.begin());
          for (unsigned int k = 0; k < dim; ++k)
            is_right = is_right &&
              std::abs(r[k] - residual.local_element(dim * i + k)) < 1e-11;
        }
    check_everywhere(is_right, "the residual is that after the last of them");
  }
} // namespace test_plane_relaxation



TEST(plane_relaxation)
{
  const auto name = [](const std::string &what) {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << what << std::endl;
  };
  name("cubes");
  test_none(1);
  name("twice as long as wide");
  test_none(2);
  name("long in x");
  test(0, false);
  name("long in x, hanging nodes");
  test(0, true);
  name("long in z");
  test(2, false);
  name("lines and planes");
  test_lines_and_planes();
}
