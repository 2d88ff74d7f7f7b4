#include <common/input_error.h>
#include <common/output/manifest.h>
#include <common/printable.h>

// A header without a library; zlib knows checksums of 32 bits only. The copy of
// Boost in deal.II's source may lack it, so CMakeLists.txt looks for it and
// says what to install. In Debian it comes with libdeal.ii-dev, whose packages
// of Boost (serialization and others) depend on the one with all headers: so
// it is with deal.II 9.4.1 in Debian 12 and with 9.7.1 in unstable.
#include <boost/crc.hpp>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

namespace Friction
{
  namespace Manifest
  {
    namespace
    {
      const std::string manifest_name = "manifest";

      // The first line. To be changed whenever the lines below change.
      const std::string manifest_format = "checkpoint, format 2";

      // Ours have a few hundred bytes.
      constexpr std::uintmax_t longest_manifest = 1 << 16;

      const std::string last_line = "checksum of these lines ";



      struct FileSummary
      {
        std::uintmax_t length = 0;
        std::uint64_t  check  = 0;
      };

      using Summaries = std::map<std::string, FileSummary>;



      std::string
      hexadecimal(const std::uint64_t number)
      {
        std::ostringstream out;
        out << std::hex << std::setw(16) << std::setfill('0') << number;
        return out.str();
      }



      std::uint64_t
      checksum_of_text(const std::string &text)
      {
        std::istringstream in(text);
        return checksum(in);
      }



      // Nothing if the file cannot be read to its end.
      std::optional<FileSummary>
      summary(const std::filesystem::path &file)
      {
        FileSummary     result;
        std::error_code error;
        result.length = std::filesystem::file_size(file, error);
        std::ifstream in(file, std::ios::binary);
        if (error || !in)
          return {};
        result.check = checksum(in);
        if (in.bad())
          return {};
        return result;
      }



      std::string
      manifest_text(const unsigned int level, const Summaries &files)
      {
        std::ostringstream text;
        text << manifest_format << "\nlevel " << level << '\n';
        for (const auto &[name, file] : files)
          text << hexadecimal(file.check) << ' ' << file.length << ' ' << name
               << '\n';
        return text.str() + last_line +
          hexadecimal(checksum_of_text(text.str())) + '\n';
      }



      // What a manifest says of files. It has to be, to the last byte, what we
      // would write if that was so.
      std::optional<Summaries>
      parse(const std::string &text, const unsigned int level)
      {
        Summaries          files;
        std::istringstream in(text);
        std::string        line;
        std::getline(in, line);
        std::getline(in, line);
        while (std::getline(in, line) && line.rfind(last_line, 0) != 0)
          {
            FileSummary        file;
            std::string        name;
            std::istringstream words(line);
            words >> std::hex >> file.check >> std::dec >> file.length >> name;
            if (!words)
              return {};
            files[name] = file;
          }
        if (manifest_text(level, files) != text)
          return {};
        return files;
      }
    } // namespace



    std::uint64_t
    checksum(std::istream &in)
    {
      boost::crc_optimal<64,
                         0x42f0e1eba9ea3693ull,
                         0xffffffffffffffffull,
                         0xffffffffffffffffull,
                         true,
                         true>
                        crc;
      std::vector<char> block(1 << 16);
      while (in)
        {
          in.read(block.data(), block.size());
          crc.process_bytes(block.data(), in.gcount());
        }
      return crc.checksum();
    }



    void
    write(const std::string &directory, const unsigned int level)
    {
      namespace fs = std::filesystem;
      Summaries files;
      for (const auto &entry : fs::directory_iterator(directory))
        {
          const std::string name = entry.path().filename().string();
          const auto        file = summary(entry.path());
          if (!file)
            throw InputError("The file '" + entry.path().string() +
                             "' cannot be read again.");
          files[name] = *file;
        }

      const fs::path name = fs::path(directory) / manifest_name;
      std::ofstream  out(name, std::ios::binary);
      out << manifest_text(level, files);
      out.close();
      if (!out)
        throw InputError("The file '" + name.string() +
                         "' cannot be written: is the disk full?");
    }



    std::string
    fault(const std::string &directory, const unsigned int level)
    {
      namespace fs        = std::filesystem;
      const auto its_file = [](const std::string &name) {
        return "its file '" + name + "' ";
      };
      const fs::path  path = fs::path(directory) / manifest_name;
      std::error_code error;
      if (!fs::is_regular_file(path, error))
        return its_file(manifest_name) +
          "is missing, which earlier versions of the program did not write";
      if (fs::file_size(path, error) > longest_manifest || error)
        return its_file(manifest_name) + "is too long";

      std::ifstream in(path, std::ios::binary);
      std::string   text(longest_manifest, ' ');
      in.read(text.data(), text.size());
      text.resize(in.gcount());
      const auto end = text.rfind(last_line);
      if (in.bad() || end == text.npos ||
          text.substr(end) !=
            last_line + hexadecimal(checksum_of_text(text.substr(0, end))) +
              '\n')
        return its_file(manifest_name) + "is not as it was written";
      if (text.rfind(manifest_format + "\n", 0) != 0)
        return "it is that of another version of the program";
      const auto files = parse(text, level);
      if (!files)
        return "it is that of another level than its name says";

      for (const auto &[name, file] : *files)
        {
          if (!fs::is_regular_file(fs::path(directory) / name, error))
            return its_file(name) + "is missing";
          const auto length = fs::file_size(fs::path(directory) / name, error);
          if (!error && length != file.length)
            return its_file(name) + "has " + counted(length, "byte", "bytes") +
              " instead of " + std::to_string(file.length);
        }
      for (fs::directory_iterator entry(directory, error), none;
           !error && entry != none;
           entry.increment(error))
        {
          const std::string name = entry->path().filename().string();
          if (name != manifest_name && files->count(name) == 0)
            return "'" + name + "' does not belong to it";
        }
      for (const auto &[name, file] : *files)
        {
          const auto found = summary(fs::path(directory) / name);
          if (!found)
            return its_file(name) + "cannot be read";
          if (found->check != file.check || found->length != file.length)
            return its_file(name) + "is not as it was written";
        }
      return "";
    }
  } // namespace Manifest
} // namespace Friction
