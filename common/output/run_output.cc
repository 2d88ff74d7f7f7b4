#include <common/algorithms/discretization_stop.h>
#include <common/compatibility.h>
#include <common/contact/solution_check.h>
#include <common/output/level_errors.h>
#include <common/output/profile.h>
#include <common/output/run_output.h>
#include <common/output/warnings.h>
#include <common/parallel/collective_error.h>
#include <common/parallel/run_clock.h>
#include <common/parameters/scene_file.h>
#include <common/printable.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include <cmath>
#include <set>
#include <sstream>

namespace Friction
{
  namespace
  {
    // To be increased whenever what is in a checkpoint changes.
    constexpr unsigned int checkpoint_format = 8;



    // What a checkpoint has to agree with.
    struct Header
    {
      unsigned int format     = checkpoint_format;
      unsigned int dimension  = 0;
      double       mesh       = 0.;
      unsigned int ids        = 0;
      unsigned int groups     = 0;
      std::string  parameters = {};

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &format &dimension &mesh &ids &groups &parameters;
      }
    };



    // A number for a sequence of them.
    class Hash
    {
    public:
      void
      add(const unsigned int number)
      {
        value = (value ^ (number + 1)) * 16777619u + 1;
      }

      unsigned int
      result() const
      {
        return value;
      }

    private:
      std::uint32_t value = 0;
    };



    // The same sections may name other parts of the same mesh: in a mesh file,
    // two groups can have exchanged their names.
    template <int dim>
    unsigned int
    hash_of_groups(const Scene<dim> &scene)
    {
      Hash hash;
      for (const types::boundary_id id : scene.boundary_ids())
        hash.add(id);
      for (const types::material_id id : scene.materials().ids())
        hash.add(id);
      return hash.result();
    }



    template <int dim>
    std::set<types::boundary_id>
    contact_boundaries(const Scene<dim> &scene)
    {
      std::set<types::boundary_id> ids;
      for (const ContactCondition<dim> &condition : scene.contact_conditions())
        if (condition.has_boundary())
          ids.insert(condition.boundary_id);
      return ids;
    }
  } // namespace



  template <int dim>
  RunOutput<dim>::RunOutput(const Parameters  &parameters,
                            const Scene<dim>  &scene,
                            std::ostream      &out,
                            const std::string &version,
                            const MPI_Comm     communicator)
    : parameters(parameters)
    , communicator(communicator)
    , directory(parameters.output.directory, communicator)
    , lock(directory, communicator)
    , the_console(out,
                  parameters.output.times ? Console::Times::shown
                                          : Console::Times::hidden,
                  parameters.output.verbosity,
                  communicator)
    , history(directory.file("history.h5"),
              {parameters.name,
               parameters.text,
               version,
               parameters.output.units,
               scene.n_contact_boundaries(),
               scene.n_load_steps() > 1},
              communicator)
    , fields(directory,
             scene.materials(),
             contact_boundaries(scene),
             parameters.output.format,
             parameters.output.principal_stresses)
    , verification(directory)
    , checkpoints(directory, communicator)
    , groups(hash_of_groups(scene))
  {}



  template <int dim>
  void
  RunOutput<dim>::check_start(const Discretization<dim> &discretization)
  {
    if (!lock.warning().empty())
      the_console.warning(printable(lock.warning()));
    const std::vector<LoadWarning> about_loads =
      warnings_about_loads(discretization);
    for (const std::string &warning :
         warnings_at_start(discretization, parameters, about_loads))
      the_console.warning(warning);
    // What is true from the beginning has been said.
    for (const LoadWarning &warning : about_loads)
      warned_about_loads.insert(warning.kind);
    if (discretization.scene().n_load_steps() > 1 && !restarted)
      announce_load_step(discretization.scene());
  }



  template <int dim>
  void
  RunOutput<dim>::begin_load_step(const Discretization<dim> &discretization)
  {
    announce_load_step(discretization.scene());
    for (const auto &[kind, sentence] : warnings_about_loads(discretization))
      if (warned_about_loads.insert(kind).second)
        the_console.warning(sentence);
  }



  template <int dim>
  void
  RunOutput<dim>::announce_load_step(const Scene<dim> &scene)
  {
    if (scene.load_step() > 0 && history.levels().back().contact_nodes > 0)
      the_console.note(describe_quantities(history.levels().back()));
    std::ostringstream text;
    text << "Load step " << scene.load_step() + 1 << " of "
         << scene.n_load_steps() << ", t = " << scene.time() << '.';
    the_console.note(text.str());
  }



  template <int dim>
  bool
  RunOutput<dim>::check_solution(const Discretization<dim> &discretization,
                                 const VectorType          &displacement,
                                 const ContactState        &state)
  {
    const RunScope      part(communicator, RunPart::records);
    const SolutionCheck check = Friction::check_solution(
      discretization,
      displacement,
      state,
      loosest_certificate_tolerance(parameters.solver));
    if (!check.sentence.empty())
      the_console.warning(
        check.is_solution ? "Warning: " +
            discretization.scene().subject_at_time() + check.sentence
                          : "No solution" + discretization.scene().at_time() +
            ": " + check.sentence);
    return check.is_solution;
  }



  template <int dim>
  bool
  RunOutput<dim>::check_solution(const NestedIteration<dim> &nest)
  {
    if (nest.report().converged)
      return check_solution(
        nest.discretization(), nest.displacement(), nest.state());
    add_failure(nest.level(), nest.scene(), nest.report());
    return false;
  }



  template <int dim>
  void
  RunOutput<dim>::check_end(const Discretization<dim> &discretization,
                            const VectorType          &displacement,
                            const ContactState        &state)
  {
    const RunScope part(communicator, RunPart::records);
    if (history.levels().back().contact_nodes > 0)
      the_console.note(describe_quantities(history.levels().back()));
    const unsigned int n_boundaries =
      discretization.scene().n_contact_boundaries();
    if (n_boundaries > 1 && history.levels().back().contact_nodes > 0)
      the_console.note("These are sums over " + std::to_string(n_boundaries) +
                       " contact boundaries, and the largest pressure on any" +
                       (last_forces.empty()
                          ? "; 'Output/Forces' has the forces on each."
                          : "."));
    if (!last_forces.empty())
      the_console.note(last_forces);
    for (const std::string &warning :
         warnings_at_end(discretization, displacement, state))
      the_console.warning(warning);
  }



  template <int dim>
  Console &
  RunOutput<dim>::console()
  {
    return the_console;
  }



  template <int dim>
  void
  RunOutput<dim>::add_level(const LevelRecords<dim>   &records,
                            const Discretization<dim> &discretization,
                            const VectorType          &displacement,
                            const Vector<float>       &cell_errors)
  {
    const RunScope part(communicator, RunPart::records);
    const bool     is_first = !any_level;
    any_level               = true;
    if (is_first && !restarted)
      remove_other_run();
    // Not that of another run, if this one writes none.
    on_first_process(communicator,
                     [&]() { verification.remove(records.level.level); });

    LevelRecord record = records.level;
    set_errors(record, history.levels(), dim);
    the_console.level_complete(record);
    if (!records.attempts.empty())
      the_console.note(records.attempts);
    if (parameters.output.profile)
      the_console.note(
        describe_profile(records,
                         parameters.output.times,
                         discretization.constraints().communicator()));
    history.add_level(
      record, records.cycles, records.contact, records.outer, records.forces);
    if (!records.forces.empty())
      last_forces = records.forces.back().balance.describe();
    if (parameters.output.fields)
      {
        const RunScope part_of_fields(communicator, RunPart::fields);
        fields.write_level(records.level.level,
                           {discretization.mapping(),
                            discretization.dof_handler(),
                            discretization.hanging_nodes(),
                            displacement,
                            cell_errors.size() > 0 ? &cell_errors : nullptr,
                            discretization.slip_origin(),
                            discretization.scene().n_load_steps() > 1
                              ? std::optional<double>(record.time)
                              : std::nullopt},
                           records.own_contact);
      }
    if (parameters.output.verification)
      verification.write_level(
        records.level.level, discretization, displacement, records.own_contact);
    if (is_first && restarted)
      remove_levels_after(records.level.level);
  }



  // These results take the place of older ones, to which checkpoints and fields
  // belong; the history will be replaced as a whole. So a run that does not get
  // to the end of its first level leaves everything as it was.
  template <int dim>
  void
  RunOutput<dim>::remove_other_run()
  {
    checkpoints.remove_all();
    remove_files([](const RunFile &) { return true; });
  }



  // The lists of levels have just been written, but only those of the present
  // format. What others name stays, and so does everything if there are no
  // fields any more: it belongs to the same problem.
  template <int dim>
  void
  RunOutput<dim>::remove_levels_after(const unsigned int level)
  {
    checkpoints.remove_after(level);
    const auto is_listed = [this](const RunFile &file) {
      if (file.what == "verify")
        return true;
      return parameters.output.fields &&
        (file.what == "contact" ||
         (file.ending == "h5") ==
           (parameters.output.format == FieldFormat::hdf5));
    };
    remove_files([&](const RunFile &file) {
      return file.unfinished ||
        (file.level > static_cast<int>(level) && is_listed(file));
    });
  }



  template <int dim>
  void
  RunOutput<dim>::remove_files(
    const std::function<bool(const RunFile &)> &is_left_over)
  {
    std::string warning;
    on_first_process(communicator, [&]() {
      warning = remove_left_overs(directory, is_left_over);
    });
    if (!warning.empty())
      the_console.warning(printable(warning));
  }



  template <int dim>
  void
  RunOutput<dim>::add_level(const NestedIteration<dim> &nest,
                            const ErrorEstimate        &estimate)
  {
    const Discretization<dim> &discretization = nest.discretization();
    LevelRecords<dim>          records        = make_level_records(nest.level(),
                                                   discretization,
                                                   nest.displacement(),
                                                   nest.state(),
                                                   nest.report());
    records.level.estimated_error             = estimate.total;
    records.level.error_at_least              = estimate.lower_bound;
    records.level.setup_seconds               = nest.setup_seconds();
    records.level.solve_seconds               = nest.solve_seconds();
    if (wants_forces())
      records.forces.push_back(
        {nest.level(), force_balance(discretization, nest.report().residual)});
    add_level(
      records, discretization, nest.displacement(), estimate.cell_errors);
    if (const auto exact = nest.scene().exact_displacement())
      add_exact_error(compute_exact_error(discretization.mapping(),
                                          discretization.dof_handler(),
                                          nest.scene().materials(),
                                          *exact,
                                          nest.displacement()),
                      /*with_order =*/parameters.refinement.strategy ==
                          RefinementStrategy::uniform &&
                        nest.scene().load_step() == 0);
  }



  template <int dim>
  void
  RunOutput<dim>::add_exact_error(const ExactError &error,
                                  const bool        with_order)
  {
    the_console.note(error.describe(with_order ? last_exact_error : 0.));
    last_exact_error = error.energy;
  }



  template <int dim>
  void
  RunOutput<dim>::nothing_to_refine(const ContactState &state)
  {
    the_console.note(
      Utilities::MPI::sum(state.n_contact(), communicator) > 0
        ? "Nothing is left to refine: there is no error."
        : "Nothing is left to refine: there is no error, and no node in "
          "contact. If there should be, start with a finer mesh.");
  }



  template <int dim>
  void
  RunOutput<dim>::add_failure(const unsigned int  level,
                              const Scene<dim>   &scene,
                              const SolverReport &report)
  {
    the_console.warning(
      "No convergence on level " + std::to_string(level) + scene.at_time() +
      " within " + counted(report.cycles.size(), "cycle", "cycles") +
      ". Certificate: " + report.certificate.describe() + ".");
  }



  template <int dim>
  const std::vector<LevelRecord> &
  RunOutput<dim>::levels() const
  {
    return history.levels();
  }



  // The coarse mesh is known to all processes. The numbers of its vertices are
  // part of the sum, which two different meshes will hardly share. The second
  // number is for the physical ids of cells and boundary, which a scene speaks
  // of.
  template <int dim>
  std::pair<double, unsigned int>
  RunOutput<dim>::fingerprint(const Triangulation<dim> &triangulation)
  {
    double sum = 0;
    Hash   hash;
    for (const auto &cell : triangulation.cell_iterators_on_level(0))
      {
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            sum += (1. + d + dim * (v + 8. * cell->index())) *
              std::abs(cell->vertex(v)[d]);
        hash.add(cell->material_id());
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            hash.add(cell->face(f)->boundary_id());
      }
    return {sum, hash.result()};
  }



  template <int dim>
  void
  RunOutput<dim>::save_checkpoint(const unsigned int         next_level,
                                  const Discretization<dim> &discretization,
                                  const std::vector<VectorType *> &vectors,
                                  const ForceControl<dim> &platens) const
  {
    if (!parameters.output.checkpoint)
      return;
    const RunScope            part(communicator, RunPart::records);
    const auto               &dof_handler   = discretization.dof_handler();
    const auto               &triangulation = dof_handler.get_triangulation();
    const unsigned int        load_step  = discretization.scene().load_step();
    const std::vector<double> of_platens = platens.checkpoint_numbers();

    Header header;
    header.dimension                       = dim;
    std::tie(header.mesh, header.ids)      = fingerprint(triangulation);
    header.groups                          = groups;
    header.parameters                      = parameters.text;
    const std::vector<Console::Note> notes = the_console.notes();

    std::ostringstream record;
    {
      boost::archive::binary_oarchive archive(record);
      archive << header << history << fields << notes << last_exact_error
              << load_step << of_platens;
    }
    const std::string bytes = record.str();
    checkpoints.save(next_level,
                     std::vector<char>(bytes.begin(), bytes.end()),
                     dof_handler,
                     {vectors.begin(), vectors.end()});
  }



  template <int dim>
  void
  RunOutput<dim>::save_checkpoint(NestedIteration<dim> &nest) const
  {
    save_checkpoint(nest.level(),
                    nest.discretization(),
                    nest.checkpoint_vectors(),
                    nest.platens());
  }



  template <int dim>
  typename RunOutput<dim>::Resumption
  RunOutput<dim>::load_checkpoint(Triangulation<dim> &triangulation)
  {
    const Checkpoints::Last last  = checkpoints.find_last();
    const unsigned int      level = last.level;
    Resumption              resumption;
    resumption.level              = level;
    const std::vector<char> bytes = checkpoints.record(level);
    if (!last.warning.empty())
      the_console.warning(printable(last.warning));

    // All processes read the same record, and find the same faults in it.
    const std::string here = "The checkpoint of level " +
      std::to_string(level) + " in '" + directory.path() + "' ";
    std::vector<Console::Note> notes;
    std::string                difference;
    Header                     header;
    std::istringstream         record(std::string(bytes.begin(), bytes.end()));
    try
      {
        boost::archive::binary_iarchive archive(record);
        archive >> header;
        if (header.format == checkpoint_format && header.dimension == dim)
          {
            archive >> history >> fields >> notes >> last_exact_error >>
              resumption.load_step >> resumption.platens;
            difference = first_difference(
              header.parameters, parameters.text, resumption.load_step == 0);
          }
      }
    catch (const std::exception &)
      {
        header.format = checkpoint_format + 1;
      }
    if (header.format != checkpoint_format)
      throw InputError(here +
                       "cannot be read; it may be damaged, or that of "
                       "another version of the program.");
    if (header.dimension != dim)
      throw InputError(here + "is that of the program for " +
                       std::to_string(header.dimension) + " dimensions.");
    if (!difference.empty())
      throw InputError(here +
                       (resumption.load_step == 0
                          ? "belongs to another problem: '"
                          : "is of a later load step, for which nothing of the "
                            "problem, of its times and of how far to refine "
                            "may change: '") +
                       difference + "' has changed.");
    const auto [mesh, ids] = fingerprint(triangulation);
    if (std::abs(header.mesh - mesh) > 1e-10 * mesh || header.ids != ids)
      throw InputError(here + "belongs to another coarse mesh.");
    if (header.groups != groups)
      throw InputError(
        here +
        "belongs to a coarse mesh in which the names of physical "
        "groups are those of other groups.");

    // Would this run have come to that level at all? In later load steps levels
    // and dofs are those of the run that wrote the checkpoint.
    if (resumption.load_step == 0)
      {
        const unsigned int dofs =
          history.levels().empty() ? 0 : history.levels().back().dofs;
        if (level > parameters.refinement.levels)
          throw InputError(here + "is further than 'Refinement/Levels=" +
                           std::to_string(parameters.refinement.levels) + "'.");
        if (dofs >= parameters.refinement.maximum_dofs)
          throw InputError(here + "is further than 'Refinement/Maximum dofs=" +
                           std::to_string(parameters.refinement.maximum_dofs) +
                           "'.");
      }

    checkpoints.load_mesh(level, triangulation);
    restarted = true;
    the_console.repeat(history.levels(), notes);
    return resumption;
  }



  template class RunOutput<2>;
  template class RunOutput<3>;
} // namespace Friction
