#include <common/output/left_overs.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <utility>
#include <vector>

namespace Friction
{
  std::optional<RunFile>
  run_file(const std::string &name)
  {
    static const std::string level = "-([0-9]{2}|[1-9][0-9]{2,5})";
    static const std::string part  = "(\\.part)?";
    static const std::regex  of_all_levels(
      "(body|contact)()()" + part + "\\.(pvd)|(body)()()" + part + "\\.(xdmf)");
    static const std::regex of_a_level(
      "(body|contact)" + level + "()" + part + "\\.(pvtu)|" + "(body|contact)" +
      level + "(\\.[0-9]{4,6})" + part + "\\.(vtu)|" + "(body|verify)" + level +
      "()" + part + "\\.(h5)");
    static const std::regex half_a_history(
      "history\\.part\\.h5|levels\\.part\\.csv");
    static const std::regex a_try("\\.writable-[0-9]+-[0-9]+");

    RunFile file;
    if (std::regex_match(name, half_a_history) || std::regex_match(name, a_try))
      {
        file.unfinished = true;
        return file;
      }
    std::smatch parts;
    if (!std::regex_match(name, parts, of_all_levels) &&
        !std::regex_match(name, parts, of_a_level))
      return {};
    // Five groups for each kind of name, of which one matches.
    for (std::size_t first = 1; first + 4 < parts.size(); first += 5)
      if (parts[first].matched)
        {
          file.what = parts[first];
          if (parts[first + 1].length() > 0)
            file.level = std::stoi(parts[first + 1]);
          file.unfinished = parts[first + 3].length() > 0;
          file.ending     = parts[first + 4];
        }
    return file;
  }



  std::string
  remove_left_overs(const RunDirectory                         &directory,
                    const std::function<bool(const RunFile &)> &is_left_over)
  {
    namespace fs = std::filesystem;
    std::error_code error;

    // Lists of levels, lists of pieces, all others.
    std::vector<std::pair<unsigned int, fs::path>> files;
    for (fs::directory_iterator entry(directory.path(), error), none;
         !error && entry != none;
         entry.increment(error))
      {
        const auto      file = run_file(entry->path().filename().string());
        std::error_code ignored;
        if (file && is_left_over(*file) && entry->is_regular_file(ignored))
          files.emplace_back(file->ending == "pvd" || file->ending == "xdmf" ? 0
                               : file->ending == "pvtu"                      ? 1
                                                        : 2,
                             entry->path());
      }
    std::sort(files.begin(), files.end());

    unsigned int n_left = 0;
    std::string  one_of_them;
    for (const auto &file : files)
      {
        fs::remove(file.second, error);
        if (error && n_left++ == 0)
          one_of_them = "'" + file.second.string() +
            "' of an earlier run cannot be removed (" + error.message() + ")";
      }
    if (n_left == 0)
      return "";
    return "Warning: " + one_of_them +
      (n_left > 1 ? ", nor can " + std::to_string(n_left - 1) + " more" : "") +
      "; remove what does not belong to this run.";
  }
} // namespace Friction
