#ifndef friction_output_manifest_h
#define friction_output_manifest_h

#include <cstdint>
#include <istream>
#include <string>

namespace Friction
{
  /**
   * The file `manifest` in the directory of a checkpoint, which says what is in
   * all others: a text with the level of the checkpoint, then name, length and
   * checksum of each file, and in the last line the checksum of all lines
   * above. With it damage is found before any of the files is read, be it a
   * bit, an end that is missing, or a whole file.
   *
   * Checksums are cyclic redundancy checks of 64 bits (CRC-64/XZ), by Boost.
   * They find any damage of up to 64 bits in a row, whatever its bits are, and
   * all but one in $2^{64}$ of other ones. They are not meant against intent.
   *
   * Functions are those of a single process.
   */
  namespace Manifest
  {
    /// The checksum of what is left of a stream.
    std::uint64_t checksum(std::istream &in);

    /**
     * Write the manifest of a directory whose files are complete and on the
     * disk. Throws an InputError if that is not possible.
     */
    void write(const std::string &directory, const unsigned int level);

    /**
     * What a directory has that contradicts its manifest, as the end of a
     * sentence about it without a full stop; or nothing if everything is as it
     * was written, and for that level.
     */
    std::string fault(const std::string &directory, const unsigned int level);
  } // namespace Manifest
} // namespace Friction

#endif
