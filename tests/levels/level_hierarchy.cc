// The levels seen nodewise, on meshes with hanging nodes.
//
// The weights between a level and the next are those of deal.II's own transfer,
// on all nodes, those at the refinement edge included; and restriction is the
// transpose of prolongation.
//
// Each leaf node that does not hang belongs to exactly one level, the finest
// one that has it as a vertex. Smoothing on a level covers exactly those nodes
// whose level function lies in the leaf space (not at the refinement edge) and
// is not a leaf function itself (touches a refined cell). What the hierarchy
// rests on: hanging nodes have no chains of masters, all masters are at the
// refinement edge of the level of the hanging node, and the hanging node itself
// never touches a refined cell.

#include <common/levels/level_hierarchy.h>

#include <deal.II/multigrid/mg_constrained_dofs.h>
#include <deal.II/multigrid/mg_transfer.h>

#include <iostream>
#include <set>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_level_hierarchy
{
  template <int dim>
  void
  test_transfer(const RandomProblem<dim> &problem, Random &random)
  {
    const DoFHandler<dim> &dof_handler = problem.discretization.dof_handler();
    const auto            &hierarchy   = problem.hierarchy();

    MGConstrainedDoFs mg_constrained_dofs;
    mg_constrained_dofs.initialize(dof_handler);
    MGTransferPrebuilt<VectorType> transfer(mg_constrained_dofs);
    transfer.build(dof_handler);

    double difference = 0, asymmetry = 0;
    for (unsigned int k = 1; k < hierarchy.n_levels(); ++k)
      {
        const auto &fine = hierarchy.level(k), &coarse = hierarchy.level(k - 1);
        VectorType  coarse_vector(dof_handler.locally_owned_mg_dofs(k - 1),
                                 MPI_COMM_WORLD),
          fine_vector(dof_handler.locally_owned_mg_dofs(k), MPI_COMM_WORLD);
        VectorType prolonged(fine_vector), restricted(coarse_vector);

        for (auto &value : coarse_vector)
          value = random(-1., 1.);
        for (auto &value : fine_vector)
          value = random(-1., 1.);
        transfer.prolongate(k, prolonged, coarse_vector);
        restricted = 0.;
        transfer.restrict_and_add(k, restricted, fine_vector);

        for (unsigned int i = 0; i < fine.n_nodes(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            {
              double value = 0;
              for (auto p = fine.parents().begin(i); p != fine.parents().end(i);
                   ++p)
                value += p->weight * coarse_vector(dim * p->node + d);
              difference =
                std::max(difference, std::abs(value - prolonged(dim * i + d)));
            }
        // Children on the finest level are leaf nodes; other nodes of that
        // level have no part in what is restricted.
        std::vector<unsigned int> fine_node(problem.constraints().n_nodes());
        const bool                finer_last = (k + 1 == hierarchy.n_levels());
        if (finer_last)
          {
            const VectorType everything(fine_vector);
            fine_vector = 0.;
            for (const auto &own : fine.own_nodes())
              {
                fine_node[own.leaf.number()] = own.node;
                for (unsigned int d = 0; d < dim; ++d)
                  fine_vector(dim * own.node + d) =
                    everything(dim * own.node + d);
              }
            restricted = 0.;
            transfer.restrict_and_add(k, restricted, fine_vector);
          }
        using Weights = std::vector<std::pair<unsigned int, float>>;
        std::vector<Weights> children(coarse.n_nodes());
        for (unsigned int i = 0; i < coarse.n_nodes(); ++i)
          if (finer_last)
            for (auto c = coarse.leaf_children().begin(i);
                 c != coarse.leaf_children().end(i);
                 ++c)
              children[i].emplace_back(fine_node[c->node.number()], c->weight);
          else
            for (auto c = coarse.children().begin(i);
                 c != coarse.children().end(i);
                 ++c)
              children[i].emplace_back(c->node, c->weight);
        for (unsigned int i = 0; i < coarse.n_nodes(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            {
              double value = 0;
              for (const auto &c : children[i])
                value += c.second * fine_vector(dim * c.first + d);
              difference =
                std::max(difference, std::abs(value - restricted(dim * i + d)));
            }

        // Entry by entry: children() is parents() transposed.
        std::set<std::tuple<unsigned int, unsigned int, double>> weights;
        std::set<unsigned int> restricted_nodes;
        for (unsigned int i = 0; i < fine.n_nodes(); ++i)
          if (!finer_last)
            restricted_nodes.insert(i);
        if (finer_last)
          for (const auto &own : fine.own_nodes())
            restricted_nodes.insert(own.node);
        for (const unsigned int i : restricted_nodes)
          for (auto p = fine.parents().begin(i); p != fine.parents().end(i);
               ++p)
            weights.emplace(i, p->node, p->weight);
        for (unsigned int i = 0; i < coarse.n_nodes(); ++i)
          for (const auto &c : children[i])
            asymmetry += 1 - weights.erase({c.first, i, c.second});
        asymmetry += weights.size();
      }
    check_below(difference, 1e-14, "prolongation and restriction of deal.II");
    check_below(asymmetry, 0., "restriction is the transpose of prolongation");
  }



  template <int dim>
  void
  test_nodes(const RandomProblem<dim> &problem)
  {
    const auto &disc        = problem.discretization;
    const auto &constraints = problem.constraints();
    const auto &hierarchy   = problem.hierarchy();
    const auto  n_leaf      = constraints.n_nodes();
    const auto  n_levels    = hierarchy.n_levels();

    // From the definitions, vertex by vertex.
    using Pair = std::pair<unsigned int, unsigned int>; // level, vertex
    std::vector<unsigned int>            vertex_of_leaf(n_leaf);
    std::vector<unsigned int>            finest(n_leaf, 0);
    std::map<Pair, unsigned int>         node_at;
    std::set<Pair>                       touches_refined;
    std::map<unsigned int, unsigned int> coarsest_active;
    for (const auto &cell : disc.dof_handler().cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          const unsigned int vertex = cell->vertex_index(v);
          const unsigned int k      = cell->level();
          node_at[{k, vertex}]      = cell->mg_vertex_dof_index(k, v, 0) / dim;
          if (cell->has_children())
            touches_refined.emplace(k, vertex);
          else
            {
              const unsigned int leaf =
                constraints.node_of_dof(cell->vertex_dof_index(v, 0));
              vertex_of_leaf[leaf] = vertex;
              finest[leaf]         = std::max(finest[leaf], k);
              const auto it        = coarsest_active.emplace(vertex, k).first;
              it->second           = std::min(it->second, k);
            }
        }

    bool finest_agrees = true, vertices_agree = true, edges_agree = true,
         flags_agree = true;
    for (unsigned int i = 0; i < n_leaf; ++i)
      finest_agrees =
        finest_agrees && hierarchy.finest_level(LeafNode(i)) == finest[i];
    for (unsigned int k = 0; k < n_levels; ++k)
      {
        const auto &level = hierarchy.level(k);
        for (unsigned int i = 0; i < n_leaf; ++i)
          if (!constraints.is_hanging(i) &&
              (finest[i] == k || finest[i] == k + 1))
            {
              const auto it  = node_at.find({k, vertex_of_leaf[i]});
              vertices_agree = vertices_agree &&
                hierarchy.node_of_leaf(k, LeafNode(i)) ==
                  (it == node_at.end() ? numbers::invalid_unsigned_int
                                       : it->second) &&
                (it == node_at.end() ||
                 level.leaf_node(it->second).number() == i);
            }
        for (unsigned int i = 0; i < n_leaf; ++i)
          {
            const auto it = node_at.find({k, vertex_of_leaf[i]});
            if (it == node_at.end())
              continue;
            const unsigned int node = it->second;
            // The edge is where a cell of a coarser level is active.
            edges_agree = edges_agree &&
              level.is_refinement_edge(node) ==
                (coarsest_active[vertex_of_leaf[i]] < k);
            flags_agree = flags_agree &&
              level.is_hanging(node) == constraints.is_hanging(i);
            for (unsigned int d = 0; d < dim; ++d)
              flags_agree = flags_agree &&
                level.is_prescribed(node, d) == constraints.is_prescribed(i, d);
          }
      }
    check(finest_agrees, "f(p) is the finest level that has p as a vertex");
    check(vertices_agree,
          "leaf nodes and level nodes are at the same vertices");
    check(flags_agree, "what is known of a leaf node is known on all levels");
    check(edges_agree, "the refinement edge is where coarser cells are active");

    // Own nodes cover the leaf space, once.
    std::vector<unsigned int> owned(n_leaf, 0);
    bool                      own_is_finest = true;
    for (unsigned int k = 0; k < n_levels; ++k)
      for (const auto &own : hierarchy.level(k).own_nodes())
        {
          ++owned[own.leaf.number()];
          own_is_finest = own_is_finest && finest[own.leaf.number()] == k;
        }
    bool once = true;
    for (unsigned int i = 0; i < n_leaf; ++i)
      once = once && owned[i] == (constraints.is_hanging(i) ? 0 : 1);
    check(once && own_is_finest,
          "each free leaf node is an own node once, on its finest level");

    // Relaxed nodes.
    bool         relaxed_agree = true, ranges_ascend = true;
    unsigned int n_relaxed = 0, n_level_nodes = 0;
    for (unsigned int k = 0; k + 1 < n_levels; ++k)
      {
        const auto       &level = hierarchy.level(k);
        std::vector<char> relaxed(level.n_nodes(), 0);
        unsigned int      last = 0;
        for (const auto &range : level.relaxed_nodes())
          {
            ranges_ascend = ranges_ascend && range.first >= last &&
              range.second > range.first;
            last = range.second;
            for (unsigned int i = range.first; i < range.second; ++i)
              relaxed[i] = 1;
          }
        for (unsigned int leaf = 0; leaf < n_leaf; ++leaf)
          {
            const unsigned int vertex = vertex_of_leaf[leaf];
            const auto         it     = node_at.find({k, vertex});
            if (it == node_at.end())
              continue;
            const bool expected = coarsest_active[vertex] >= k &&
              touches_refined.count({k, vertex}) > 0 &&
              !constraints.is_fixed(leaf);
            relaxed_agree = relaxed_agree && relaxed[it->second] == expected;
            n_relaxed += relaxed[it->second];
          }
        n_level_nodes += level.n_nodes();
      }
    check(relaxed_agree,
          "relaxed are the free nodes off the edge that touch a refined cell");
    check(ranges_ascend, "ranges of relaxed nodes are disjoint and ascend");
    std::cout << n_relaxed << " of " << n_level_nodes
              << " nodes of correction levels are relaxed" << std::endl;

    // Hanging nodes.
    bool one_level = true, never_refined = true, no_chain = true,
         masters_at_edge = true;
    for (unsigned int i = 0; i < n_leaf; ++i)
      if (constraints.is_hanging(i))
        {
          const unsigned int vertex           = vertex_of_leaf[i];
          unsigned int       n_levels_with_it = 0;
          for (unsigned int k = 0; k < n_levels; ++k)
            n_levels_with_it += node_at.count({k, vertex});
          one_level            = one_level && n_levels_with_it == 1;
          const unsigned int l = finest[i];
          never_refined =
            never_refined && touches_refined.count({l, vertex}) == 0;
          for (const auto &master :
               *disc.hanging_nodes().get_constraint_entries(
                 constraints.partitioner()->local_to_global(dim * i)))
            {
              const unsigned int m = constraints.node_of_dof(master.first);
              no_chain             = no_chain && !constraints.is_hanging(m);
              const auto it        = node_at.find({l, vertex_of_leaf[m]});
              masters_at_edge      = masters_at_edge && it != node_at.end() &&
                hierarchy.level(l).is_refinement_edge(it->second) &&
                node_at.count({l - 1, vertex_of_leaf[m]}) > 0;
            }
        }
    check(one_level && never_refined,
          "a hanging node is on one level only and touches no refined cell");
    check(no_chain && masters_at_edge,
          "its masters are free, at the edge of that level, and one below");
  }



  template <int dim>
  void
  test(const unsigned int seed)
  {
    Random                   random(seed);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::coulomb, .4),
      dim == 2 ? 4 : 3,
      dim == 2 ? .5 : .3,
      random);
    const Truncation<dim> truncation = random_truncation<dim>(
      problem.constraints(), problem.contact(), 0., random);
    std::cout << dim << "D, " << problem.hierarchy().n_levels() << " levels, "
              << problem.constraints().n_nodes() << " nodes, "
              << problem.n_hanging() << " hang, "
              << problem.n_hanging_with_truncated_master(truncation)
              << " with a master at contact" << std::endl;
    test_transfer(problem, random);
    test_nodes(problem);
  }
} // namespace test_level_hierarchy

TEST(level_hierarchy)
{
  test<2>(1);
  test<2>(2);
  test<3>(3);
}
