// What does accuracy cost? A nested iteration is followed from level to level
// with a clock running, and in the end the solutions of all levels are compared
// with one that is better: the exact one if the scene knows it, otherwise that
// of a mesh two levels finer than the last one.
//
// Usage: benchmark-precision 2|3 scene.prm --table=FILE [option ...]
//                            [Section/Entry=value ...]
//
//   --reference=uniform:N, --reference=adaptive:N
//       the reference is solved on the last mesh refined N times more, in all
//       of its cells or where the estimator wants it. Default: uniform:2.
//   --half-widths=CONTACT,STICK
//       the half-widths of the zones of contact and stick, where they are known
//       better than from the reference; required with an exact solution.
//
// The seconds of a level are all those from the start of the program's work to
// the solution on this level: meshes, assembly, set-up, solution, and on the
// levels before also estimation, marking and interpolation. What is done for
// the comparison only is not counted.
//
// All errors are relative:
// - energy: that of the difference over that of the reference solution;
// - pressure: h^{1/2}(p_h-p) in the lumped L2 norm of the contact boundary, as
//   a part of a^{1/2} p in the same norm. Here h is the local size of the faces
//   of the level's own mesh, and a the contact half-width of the reference, so
//   that a number without unit results that does not depend on the choice of
//   units;
// - half-widths: over those of the reference. They are those that the programs
//   write to their history, sums of nodal measures, and so multiples of about
//   half a face.
//
// Against a reference solution the pressure of a level is its piecewise linear
// interpolation on the reference mesh, and against an exact one it is compared
// at the level's own nodes. On a round boundary the meshes of the levels are
// different bodies, and this is part of the errors.

#include <deal.II/base/timer.h>
#include <deal.II/base/utilities.h>

#include <deal.II/grid/cell_id.h>

#include <common/algorithms/nested_iteration.h>
#include <common/estimate/exact_error.h>
#include <common/output/level_records.h>
#include <tests/benchmarks/benchmark.h>
#include <tests/support/discretized.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace benchmark_precision
{
  using namespace Tests;

  /** What is said on the command line besides the scene and its overrides. */
  struct Options
  {
    std::string        table;
    RefinementStrategy reference_strategy = RefinementStrategy::uniform;
    unsigned int       finer              = 2;

    /// Contact and stick, or empty if those of the reference will do.
    std::vector<double> half_widths;
  };



  /**
   * Finite element functions on a mesh that is refined later on: the values at
   * the vertices of each active cell.
   */
  template <int dim>
  class CoarseFunctions
  {
  public:
    static constexpr unsigned int n_vertices =
      GeometryInfo<dim>::vertices_per_cell;

    /** The values of both functions at a vertex, and the size of the cell's
     * faces on the contact boundary, zero if it has none. */
    struct CellValues
    {
      std::array<Tensor<1, dim>, n_vertices> displacement;
      std::array<Tensor<1, dim>, n_vertices> tractions;
      double                                 face_size = 0;
    };

    /** The functions on the refined mesh, as vectors, and at each contact node
     * the size of the coarse faces around it. */
    struct Interpolated
    {
      VectorType          displacement, tractions;
      std::vector<double> face_size;
    };

    CoarseFunctions(const DoFHandler<dim>   &dof_handler,
                    const types::boundary_id contact_boundary,
                    const VectorType        &displacement,
                    const VectorType        &tractions)
    {
      for (const auto &cell : dof_handler.active_cell_iterators())
        {
          CellValues values;
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int c = 0; c < dim; ++c)
              {
                const auto dof            = cell->vertex_dof_index(v, c);
                values.displacement[v][c] = displacement(dof);
                values.tractions[v][c]    = tractions(dof);
              }
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary() && face->boundary_id() == contact_boundary)
              values.face_size = std::max(
                values.face_size, face->diameter() / std::sqrt(dim - 1.));
          cells[cell->id()] = values;
        }
    }

    /** Interpolates to the same or a finer mesh. */
    Interpolated
    on(const Discretization<dim> &d) const
    {
      Interpolated result;
      result.displacement.reinit(d.constraints().partitioner());
      result.tractions.reinit(d.constraints().partitioner());
      result.face_size.assign(d.constraints().n_nodes(), 0.);
      for (const auto &cell : d.dof_handler().cell_iterators_on_level(0))
        descend(cell, nullptr, d.constraints(), result);
      return result;
    }

  private:
    std::map<CellId, CellValues> cells;

    // From a cell to its children, with the values of an ancestor that was
    // active, once there is one. At the vertices of a child these are the means
    // of those at the ends of an edge, the corners of a face or of the cell.
    void
    descend(const typename DoFHandler<dim>::cell_iterator &cell,
            const CellValues                              *values,
            const NodalConstraints<dim>                   &constraints,
            Interpolated                                  &result) const
    {
      if (values == nullptr)
        {
          const auto found = cells.find(cell->id());
          if (found != cells.end())
            values = &found->second;
        }
      if (cell->is_active())
        {
          AssertThrow(values != nullptr,
                      ExcMessage("The meshes are not nested."));
          for (const unsigned int v : cell->vertex_indices())
            {
              for (unsigned int c = 0; c < dim; ++c)
                {
                  const auto dof           = cell->vertex_dof_index(v, c);
                  result.displacement(dof) = values->displacement[v][c];
                  result.tractions(dof)    = values->tractions[v][c];
                }
              double &size = result.face_size[constraints.node_of_dof(
                cell->vertex_dof_index(v, 0))];
              size         = std::max(size, values->face_size);
            }
          return;
        }
      for (unsigned int child = 0; child < cell->n_children(); ++child)
        if (values == nullptr)
          descend(cell->child(child), nullptr, constraints, result);
        else
          {
            CellValues part;
            part.face_size = values->face_size;
            for (unsigned int v = 0; v < n_vertices; ++v)
              {
                const Point<dim> p =
                  GeometryInfo<dim>::child_to_cell_coordinates(
                    GeometryInfo<dim>::unit_cell_vertex(v), child);
                for (unsigned int w = 0; w < n_vertices; ++w)
                  {
                    const double weight =
                      GeometryInfo<dim>::d_linear_shape_function(p, w);
                    part.displacement[v] += weight * values->displacement[w];
                    part.tractions[v] += weight * values->tractions[w];
                  }
              }
            descend(cell->child(child), &part, constraints, result);
          }
    }
  };



  /** What is known of a level when it has been solved. */
  struct Row
  {
    unsigned int level, dofs, cycles;
    double       total_seconds, solve_seconds;
    double       contact_half_width, stick_half_width;
    double       estimated_error; ///< relative
    double       energy_error = 0, pressure_error = 0;
  };



  /** Euclidean energy norm by the matrix of a discretisation. */
  template <int dim>
  double
  energy_norm(const Discretization<dim> &d, const VectorType &v)
  {
    VectorType Av(v);
    d.stiffness().blocks().vmult(Av.begin(), v.begin());
    double square = 0;
    for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
      if (!d.constraints().is_hanging(i))
        for (unsigned int c = 0; c < dim; ++c)
          square +=
            v.local_element(dim * i + c) * Av.local_element(dim * i + c);
    return std::sqrt(square);
  }



  /** Pressure of a field of tractions at a contact node. */
  template <int dim>
  double
  pressure(const ContactNode<dim> &node, const VectorType &tractions)
  {
    double result = 0;
    for (unsigned int c = 0; c < dim; ++c)
      result -= node.normal()[c] * tractions.local_element(dim * node.node + c);
    return result;
  }



  /** The pressure that belongs to a displacement which is known as a function.
   */
  template <int dim>
  double
  exact_pressure(const Scene<dim> &scene, const ContactNode<dim> &node)
  {
    Tensor<2, dim> gradient;
    for (unsigned int c = 0; c < dim; ++c)
      gradient[c] = scene.exact_displacement()->gradient(node.point, c);
    return -scene.materials().base().lambda() * trace(gradient) -
      2. * scene.materials().base().mu() *
      (node.normal() * (gradient * node.normal()));
  }



  /** One nested iteration, with a clock that can be stopped. */
  template <int dim>
  class WorkAndPrecision
  {
  public:
    WorkAndPrecision(const Parameters &parameters, const Options &options)
      : parameters(parameters)
      , options(options)
    {}

    void
    run()
    {
      NestedIteration<dim> nest(parameters);
      nest.begin();
      const bool exact = nest.scene().exact_displacement() != nullptr;
      if (exact && options.half_widths.empty())
        throw InputError(
          "A scene with an exact solution needs "
          "--half-widths=CONTACT,STICK: the program cannot know them.");
      bool another = true;
      while (another)
        {
          solve(nest);
          clock.stop();
          add_row(nest);
          if (exact)
            compare_with_exact(nest);
          else
            functions.emplace_back(
              nest.discretization().dof_handler(),
              nest.scene().contact_conditions()[0].boundary_id,
              nest.displacement(),
              nest.tractions());
          clock.start();
          another = nest.advance();
        }
      std::string reference = "exact solution";
      if (exact)
        {
          contact_half_width = options.half_widths[0];
          stick_half_width   = options.half_widths[1];
        }
      else
        {
          for (unsigned int i = 0; i < options.finer; ++i)
            {
              if (options.reference_strategy == RefinementStrategy::uniform)
                nest.mark_all();
              else
                nest.mark(nest.estimate());
              nest.refine();
              solve(nest);
            }
          compare_with_reference(nest);
          char text[200];
          std::snprintf(text,
                        sizeof text,
                        "%u dofs, estimated error %.6e",
                        static_cast<unsigned int>(
                          nest.discretization().dof_handler().n_dofs()),
                        estimate(nest));
          reference = text;
        }
      write(reference);
    }

  private:
    const Parameters                  parameters;
    const Options                     options;
    Timer                             clock;
    std::vector<Row>                  rows;
    std::vector<CoarseFunctions<dim>> functions;
    double contact_half_width = 0, stick_half_width = 0; // of the reference

    void
    solve(NestedIteration<dim> &nest)
    {
      nest.solve();
      const unsigned int n_dofs = nest.discretization().dof_handler().n_dofs();
      std::printf("%s %s level %2u: %8u dofs, %3u cycles, %8.2f s\n",
                  parameters.name.c_str(),
                  strategy().c_str(),
                  nest.level(),
                  n_dofs,
                  static_cast<unsigned int>(nest.report().cycles.size()),
                  clock.wall_time());
      std::fflush(stdout);
      AssertThrow(
        nest.report().converged,
        ExcMessage("Not converged: " + nest.report().certificate.describe()));
    }

    std::string
    strategy() const
    {
      return parameters.refinement.strategy == RefinementStrategy::uniform
        ? "uniform"
        : "adaptive";
    }

    double
    estimate(const NestedIteration<dim> &nest) const
    {
      return nest.estimate().relative();
    }

    LevelRecord
    record(const NestedIteration<dim> &nest) const
    {
      return make_level_records(nest.level(),
                                nest.discretization(),
                                nest.displacement(),
                                nest.state(),
                                nest.report())
        .level;
    }

    void
    add_row(const NestedIteration<dim> &nest)
    {
      const LevelRecord level = record(nest);
      Row               row;
      row.level              = level.level;
      row.dofs               = level.dofs;
      row.cycles             = level.cycles;
      row.total_seconds      = clock.wall_time();
      row.solve_seconds      = nest.solve_seconds();
      row.contact_half_width = level.contact_half_width;
      row.stick_half_width   = level.stick_half_width;
      row.estimated_error    = estimate(nest);
      rows.push_back(row);
    }

    void
    compare_with_exact(const NestedIteration<dim> &nest)
    {
      const Discretization<dim> &d     = nest.discretization();
      const auto                 error = [&](const VectorType &v) {
        return compute_exact_error(d.mapping(),
                                   d.dof_handler(),
                                   nest.scene().materials(),
                                   *nest.scene().exact_displacement(),
                                   v)
          .energy;
      };
      VectorType zero(nest.displacement());
      zero = 0.;
      zero.update_ghost_values();
      rows.back().energy_error = error(nest.displacement()) / error(zero);

      const auto sizes =
        CoarseFunctions<dim>(d.dof_handler(),
                             nest.scene().contact_conditions()[0].boundary_id,
                             nest.displacement(),
                             nest.tractions())
          .on(d)
          .face_size;
      double difference = 0, norm = 0;
      for (const ContactNode<dim> &node : d.contact())
        {
          const double p = exact_pressure(nest.scene(), node);
          const double e = pressure(node, nest.tractions()) - p;
          difference += node.measure * sizes[node.node] * e * e;
          norm += node.measure * p * p;
        }
      rows.back().pressure_error =
        std::sqrt(difference / (options.half_widths[0] * norm));
    }

    void
    compare_with_reference(const NestedIteration<dim> &nest)
    {
      const Discretization<dim> &d     = nest.discretization();
      const LevelRecord          level = record(nest);
      contact_half_width               = level.contact_half_width;
      stick_half_width                 = level.stick_half_width;
      if (!options.half_widths.empty())
        {
          contact_half_width = options.half_widths[0];
          stick_half_width   = options.half_widths[1];
        }

      double norm_of_pressure = 0;
      for (const ContactNode<dim> &node : d.contact())
        norm_of_pressure +=
          node.measure * std::pow(pressure(node, nest.tractions()), 2);
      const double norm = energy_norm(d, nest.displacement());
      for (unsigned int k = 0; k < rows.size(); ++k)
        {
          auto of_level = functions[k].on(d);
          of_level.displacement -= nest.displacement();
          rows[k].energy_error = energy_norm(d, of_level.displacement) / norm;
          double difference    = 0;
          for (const ContactNode<dim> &node : d.contact())
            {
              const double e = pressure(node, of_level.tractions) -
                pressure(node, nest.tractions());
              difference +=
                node.measure * of_level.face_size[node.node] * e * e;
            }
          rows[k].pressure_error =
            std::sqrt(difference / (contact_half_width * norm_of_pressure));
        }
    }

    // Complete or not at all: written beside, then renamed.
    void
    write(const std::string &reference) const
    {
      AssertThrow(
        contact_half_width > 0 && stick_half_width > 0,
        ExcMessage("The reference has no zone of contact or stick, so "
                   "that there is nothing to be compared with."));
      const std::string unfinished = options.table + ".part";
      std::ofstream     file(unfinished);
      file.precision(9);
      file << "# reference: " << reference << '\n'
           << "# contact_half_width=" << contact_half_width
           << " stick_half_width=" << stick_half_width << '\n'
           << "scene,strategy,level,dofs,total_seconds,solve_seconds,"
              "energy_error,pressure_error,contact_half_width_error,"
              "stick_half_width_error,cycles,estimated_error\n";
      for (const Row &row : rows)
        file << parameters.name << ',' << strategy() << ',' << row.level << ','
             << row.dofs << ',' << row.total_seconds << ',' << row.solve_seconds
             << ',' << row.energy_error << ',' << row.pressure_error << ','
             << std::abs(row.contact_half_width / contact_half_width - 1) << ','
             << std::abs(row.stick_half_width / stick_half_width - 1) << ','
             << row.cycles << ',' << row.estimated_error << '\n';
      file.close();
      if (!file || std::rename(unfinished.c_str(), options.table.c_str()) != 0)
        throw InputError("The table " + options.table + " cannot be written.");
    }
  };



  // Takes the options away from the arguments.
  Options
  take_options(std::vector<std::string> &arguments)
  {
    Options                  options;
    std::vector<std::string> others;
    for (const std::string &argument : arguments)
      {
        const std::size_t end  = argument.find('=');
        const std::string name = argument.substr(0, end);
        const std::string value =
          argument.substr(std::min(end, argument.size() - 1) + 1);
        if (name == "--table")
          options.table = value;
        else if (name == "--reference")
          {
            const std::size_t colon = value.find(':');
            const std::string how   = value.substr(0, colon);
            if (colon == std::string::npos ||
                (how != "uniform" && how != "adaptive"))
              throw InputError("--reference is uniform:N or adaptive:N, not " +
                               value + ".");
            options.reference_strategy = how == "uniform"
              ? RefinementStrategy::uniform
              : RefinementStrategy::adaptive;
            options.finer = Utilities::string_to_int(value.substr(colon + 1));
          }
        else if (name == "--half-widths")
          {
            options.half_widths = Utilities::string_to_double(
              Utilities::split_string_list(value, ','));
            if (options.half_widths.size() != 2)
              throw InputError("--half-widths wants two numbers, not " + value +
                               ".");
          }
        else if (name.compare(0, 2, "--") == 0)
          throw InputError("There is no option " + name + ".");
        else
          others.push_back(argument);
      }
    if (options.table.empty())
      throw InputError("--table=FILE is missing.");
    arguments = others;
    return options;
  }
} // namespace benchmark_precision



BENCHMARK(precision)
{
  try
    {
      const std::string dimension = argc < 4 ? "" : argv[1];
      if (dimension != "2" && dimension != "3")
        {
          std::cerr << "Usage: benchmark-precision 2|3 scene.prm --table=FILE "
                       "[--reference=uniform:N|adaptive:N] "
                       "[--half-widths=CONTACT,STICK] "
                       "[Section/Entry=value ...]\n";
          return 2;
        }
      if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
        throw Friction::InputError("This is measured on one process only.");
      std::vector<std::string> arguments(argv + 3, argv + argc);
      const auto               options = take_options(arguments);
      const auto parameters = Friction::read_parameters(argv[2], arguments);
      if (dimension == "2")
        WorkAndPrecision<2>(parameters, options).run();
      else
        WorkAndPrecision<3>(parameters, options).run();
    }
  catch (const Friction::InputError &error)
    {
      std::cerr << error.what() << std::endl;
      return 2;
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
  return 0;
}
