#include <common/output/profile.h>
#include <common/parallel/reductions.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

namespace Friction
{
  template <int dim>
  std::string
  describe_profile(const LevelRecords<dim> &records,
                   const bool               with_times,
                   const MPI_Comm           communicator)
  {
    constexpr unsigned int n_columns = 5;
    std::vector<double>    largest;
    PhaseCost              total;
    const auto             append = [&](const PhaseCost &cost) {
      largest.insert(largest.end(),
                     {1. * cost.messages,
                      1. * cost.bytes,
                      1. * cost.reductions,
                      cost.seconds,
                      cost.waiting});
    };
    for (const PhaseCost &cost : records.costs)
      {
        append(cost);
        total.messages += cost.messages;
        total.bytes += cost.bytes;
        total.reductions += cost.reductions;
        total.seconds += cost.seconds;
        total.waiting += cost.waiting;
      }
    append(total);
    max_over_processes(largest, communicator);

    std::ostringstream text;
    text << "         per cycle and process  messages       bytes  reductions"
         << (with_times ? "   seconds of all   waiting" : "");
    const double cycles = std::max(1u, records.level.cycles);
    for (unsigned int row = 0; row <= n_solver_phases; ++row)
      {
        const double *value = &largest[n_columns * row];
        text << "\n         " << std::left << std::setw(20)
             << (row == n_solver_phases
                   ? "all"
                   : name_of(static_cast<SolverPhase>(row)))
             << std::right << std::fixed << std::setprecision(1)
             << std::setw(12) << value[0] / cycles << std::setprecision(0)
             << std::setw(12) << value[1] / cycles << std::setprecision(1)
             << std::setw(12) << value[2] / cycles;
        if (with_times)
          text << std::setprecision(3) << std::setw(17) << value[3]
               << std::setw(10) << value[4];
      }

    dealii::Utilities::System::MemoryStats stats;
    dealii::Utilities::System::get_memory_stats(stats);
    const auto bytes =
      sum_over_processes(std::array<double, 3>{{1. * records.matrix_memory,
                                                1. * records.solver_memory,
                                                1024. * stats.VmHWM}},
                         communicator);
    text << std::setprecision(0) << "\n         bytes per dof: leaf matrix "
         << bytes[0] / records.level.dofs << ", smoother and levels "
         << bytes[1] / records.level.dofs;
    if (with_times)
      text << ", processes at their largest " << bytes[2] / records.level.dofs;
    return text.str();
  }



  template std::string
  describe_profile(const LevelRecords<2> &, const bool, const MPI_Comm);
  template std::string
  describe_profile(const LevelRecords<3> &, const bool, const MPI_Comm);
} // namespace Friction
