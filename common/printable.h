#ifndef friction_printable_h
#define friction_printable_h

#include <cstddef>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * The number of bytes of the character of UTF-8 that begins at byte @p i, or
   * 0 if there is none, or none that should reach a terminal: control
   * characters, and those that change the direction of what follows or cannot
   * be seen.
   */
  inline std::size_t
  printable_bytes(const std::string &text, const std::size_t i)
  {
    const unsigned char first = text[i];
    if (first < 0x80)
      return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t n = (first >= 0xc2 && first < 0xe0     ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0);
    if (n == 0 || i + n > text.size())
      return 0;
    unsigned long code = first & (0xff >> (n + 1));
    for (std::size_t j = i + 1; j < i + n; ++j)
      {
        const unsigned char byte = text[j];
        if ((byte & 0xc0) != 0x80)
          return 0;
        code = (code << 6) | (byte & 0x3f);
      }
    const auto between = [&](const unsigned long a, const unsigned long b) {
      return code >= a && code <= b;
    };
    const bool longer_than_needed =
      (n == 3 && code < 0x800) || (n == 4 && code < 0x10000);
    const bool no_character = between(0xd800, 0xdfff) || code > 0x10ffff;
    const bool invisible    = between(0x80, 0x9f) || between(0x200b, 0x200f) ||
      between(0x2028, 0x202e) || between(0x2060, 0x206f) || code == 0xfeff;
    return longer_than_needed || no_character || invisible ? 0 : n;
  }



  /**
   * The characters of a text, one by one; in place of each byte that is no
   * printable character stands `\xNN`, which is what it is.
   */
  inline std::vector<std::string>
  printable_characters(const std::string &text)
  {
    const char *const        digits = "0123456789abcdef";
    std::vector<std::string> characters;
    for (std::size_t i = 0; i < text.size();)
      {
        const std::size_t n = printable_bytes(text, i);
        if (n > 0)
          characters.push_back(text.substr(i, n));
        else
          {
            const unsigned char byte = text[i];
            characters.push_back(std::string("\\x") + digits[byte / 16] +
                                 digits[byte % 16]);
          }
        i += (n > 0 ? n : 1);
      }
    return characters;
  }



  /** A number and what there are so many of: "1 vertex", "2 vertices". */
  inline std::string
  counted(const std::size_t  n,
          const std::string &one,
          const std::string &several)
  {
    return std::to_string(n) + " " + (n == 1 ? one : several);
  }



  /** A number with some digits. */
  inline std::string
  number(const double x, const unsigned int n_digits = 3)
  {
    std::ostringstream text;
    text.precision(n_digits);
    text << x;
    return text.str();
  }



  /** A point, deal.II's: "(0.5, 1)". */
  template <typename Point>
  std::string
  coordinates(const Point &p)
  {
    std::string text;
    for (unsigned int d = 0; d < Point::dimension; ++d)
      text += (d == 0 ? "(" : ", ") + number(p[d], 6);
    return text + ')';
  }



  /**
   * What a user gave us, as it may be printed: what is not printable is written
   * as `\xNN`. The result is one line.
   */
  inline std::string
  printable(const std::string &text)
  {
    std::string result;
    for (const std::string &character : printable_characters(text))
      result += character;
    return result;
  }



  /**
   * The same for quoting it in a sentence: of what is wider than @p most
   * columns, the beginning and the end, with three dots between them.
   */
  inline std::string
  excerpt(const std::string &text, const std::size_t most = 60)
  {
    // A character has four bytes at most. Of a very long text only its ends are
    // looked at; a character that this cuts in two is far from what is kept.
    const bool very_long  = text.size() > 8 * most;
    const auto characters = printable_characters(
      very_long ? text.substr(0, 4 * most) + text.substr(text.size() - 4 * most)
                : text);
    const auto width = [](const std::string &character) {
      return character[0] == '\\' ? character.size() : 1;
    };

    std::size_t whole = 0;
    for (const std::string &character : characters)
      whole += width(character);
    if (!very_long && whole <= most)
      return printable(text);

    std::size_t room = most - most / 3 - 3;
    std::string beginning;
    for (auto c = characters.begin(); width(*c) <= room; ++c)
      {
        beginning += *c;
        room -= width(*c);
      }
    room = most / 3;
    std::string end;
    for (auto c = characters.rbegin(); width(*c) <= room; ++c)
      {
        end = *c + end;
        room -= width(*c);
      }
    return beginning + "..." + end;
  }



  /**
   * Print a line to standard error, at once: error streams have no buffer, and
   * what mpirun says of a process that fails may come between two pieces.
   */
  inline void
  print_error(const std::string &line)
  {
    std::cerr << line + '\n' << std::flush;
  }
} // namespace Friction

#endif
