// ContactZone on a row of contact nodes, where it can be counted: the nearest
// node if nobody touches, with layers on both sides that are twice as many each
// time; what touches, has a normal force or is in the obstacle; most nodes are
// all of them; and nodes whose bound of friction is given are always there. The
// same on any number of processes.

#include <common/algorithms/contact_zone.h>
#include <common/algorithms/nested_iteration.h>
#include <common/parallel/reductions.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_contact_zone
{
  struct Row
  {
    NestedIteration<2> nest;
    VectorType         u;
    ContactState       state;

    explicit Row(const std::string &law)
      : nest(read_parameters(SCENES_DIR "/block.prm",
                             {"Scene/Size=10, 1",
                              "Scene/Subdivisions=100, 2",
                              "Refinement/Initial refinements=0",
                              "Obstacle/Point=0, -0.1",
                              "Obstacle/Normal=-0.001, -1",
                              "Boundary conditions/Displacement=3: 0, 0",
                              "Contact/Friction law=" + law}))
      , state(0, false)
    {
      nest.begin();
      u     = nest.discretization().vector();
      state = ContactState(nest.discretization().contact().size(), true);
    }

    // The contact node at this place, if it is here.
    template <typename Change>
    void
    at(const double x, const Change &change)
    {
      const auto &contact = nest.discretization().contact();
      for (unsigned int p = 0; p < contact.size(); ++p)
        if (std::abs(contact[p].point[0] - x) < 1e-6)
          change(p, contact[p]);
    }
  };



  // The rows of all processes.
  std::shared_ptr<NodePattern>
  whole_pattern(const Discretization<2> &d)
  {
    const NodeBlockMatrix<2> &A     = d.problem().stiffness.blocks();
    const NodeNumbering      &nodes = d.constraints().numbering();
    std::vector<unsigned int> lengths, columns;
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      {
        lengths.push_back(A.row_end(i) - A.row_begin(i));
        for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
          columns.push_back(nodes.global(A.column(e)));
      }
    lengths     = gather_from_all(lengths, MPI_COMM_WORLD);
    columns     = gather_from_all(columns, MPI_COMM_WORLD);
    auto result = std::make_shared<NodePattern>();
    auto next   = columns.begin();
    for (const unsigned int length : lengths)
      {
        std::vector<unsigned int> row(next, next + length);
        result->append_row(row);
        next += length;
      }
    return result;
  }



  void
  print(const std::string &what, const bool grows, const ContactZone<2> &zone)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << what << ": " << (grows ? "" : "no more, ")
                << std::count(zone.nodes().begin(), zone.nodes().end(), 1)
                << " nodes" << std::endl;
  }
} // namespace test_contact_zone



TEST(contact_zone)
{
  using namespace test_contact_zone;
  {
    Row                      row("Coulomb");
    const Discretization<2> &d       = row.nest.discretization();
    const auto               problem = d.problem();
    const auto               pattern = whole_pattern(d);
    ContactZone<2>           zone(problem, *pattern);
    const auto               grow = [&](const std::string &what) {
      const bool misses = zone.misses(row.u, row.state);
      const bool grows  = zone.grow(row.u, row.state);
      print(what, grows, zone);
      check_everywhere(what == "nobody touches" || misses == grows,
                       "  as it has said");
    };
    grow("nobody touches");
    grow("nobody touches, once more");
    row.at(3., [&](const unsigned int p, const ContactNode<2> &) {
      row.state.set(p, true, false);
    });
    grow("one is said to touch");
    row.at(5., [&](const unsigned int, const ContactNode<2> &node) {
      row.u.local_element(2 * node.node + 1) = -.11;
    });
    grow("one is in the obstacle");
    row.at(5.5, [&](const unsigned int p, const ContactNode<2> &) {
      row.state.set_normal_force(p, 1.);
    });
    grow("one of the zone has a force");
    row.at(9.5, [&](const unsigned int p, const ContactNode<2> &) {
      row.state.set_normal_force(p, 1.);
    });
    grow("another one has a force");
    check_everywhere(!zone.grow_to_all(), "  which are all");
  }
  {
    Row                      row("Tresca");
    const Discretization<2> &d       = row.nest.discretization();
    const auto               problem = d.problem();
    const auto               pattern = whole_pattern(d);
    ContactZone<2>           zone(problem, *pattern);
    const bool               grows = zone.grow(row.u, row.state);
    print("bounds are given", grows, zone);
  }
}
