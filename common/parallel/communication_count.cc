#include <common/parallel/communication_count.h>

namespace Friction
{
  namespace
  {
    CommunicationCounts counts;
    SolverPhase         present = SolverPhase::other;

    CommunicationCount &
    present_count()
    {
      return counts[static_cast<unsigned int>(present)];
    }
  } // namespace



  const char *
  name_of(const SolverPhase phase)
  {
    constexpr const char *names[n_solver_phases] = {"leading sweeps",
                                                    "coarse sweeps",
                                                    "transfer",
                                                    "coarsest",
                                                    "matrix updates",
                                                    "line search",
                                                    "other"};
    return names[static_cast<unsigned int>(phase)];
  }



  CommunicationCount
  CommunicationCount::operator-(const CommunicationCount &other) const
  {
    return {messages - other.messages,
            bytes - other.bytes,
            reductions - other.reductions};
  }



  const CommunicationCounts &
  communication_counts()
  {
    return counts;
  }



  CommunicationPhase::CommunicationPhase(const SolverPhase phase)
    : before(present)
  {
    present = phase;
  }



  CommunicationPhase::~CommunicationPhase()
  {
    present = before;
  }



  void
  count_message(const std::size_t bytes)
  {
    ++present_count().messages;
    present_count().bytes += bytes;
  }



  void
  count_reduction()
  {
    ++present_count().reductions;
  }
} // namespace Friction
