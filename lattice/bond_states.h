#pragma once

#include <cstdint>
#include <vector>

#include "lattice/triangular_lattice.h"
#include "support/zero_pages.h"

namespace latcon::lattice
{

/// Bonds that are present and bonds that are toughened, two bits per bond: one word for each six kinds of bonds that
/// start at a place, with the present kinds in the lower byte and the toughened kinds in the upper one. The first word
/// of all places comes first, then the second: on the lattice that of the third-nearest neighbours.
class BondStates
{
public:
  using Word = std::uint16_t;
  using Words = std::vector<Word, support::ZeroPages<Word>>;
  static constexpr std::size_t kinds_per_word = 2 * n_kinds_per_shell;

  /// No bonds at all at n places. @param n_kinds kinds of bonds that may be added: the first so many
  void clear(std::size_t n, std::size_t n_kinds = kinds_per_word)
  {
    n_kinds_ = n_kinds;
    words_.clear();
    for (std::size_t first = 0; first < n_kinds; first += kinds_per_word)
      words_.emplace_back(n);
  }
  std::size_t n_kinds() const { return n_kinds_; } ///< kinds of bonds that may be there

  bool present(std::size_t place, std::size_t kind) const { return has(place, kind, bit(kind)); }
  bool toughened(std::size_t place, std::size_t kind) const { return has(place, kind, toughened_bit(kind)); }

  /// Makes a bond of one of these kinds present, and not toughened.
  void add(std::size_t place, std::size_t kind)
  {
    remove(place, kind);
    words_[kind / kinds_per_word][place] |= bit(kind);
  }
  void remove(std::size_t place, std::size_t kind)
  {
    if (kind < n_kinds())
      words_[kind / kinds_per_word][place] &= static_cast<Word>(~(bit(kind) | toughened_bit(kind)));
  }
  /// Toughens a bond that is present.
  void toughen(std::size_t place, std::size_t kind) { words_[kind / kinds_per_word][place] |= toughened_bit(kind); }

  /// The words that hold a kind of bonds below n_kinds(), one a place.
  const Word *words(std::size_t kind) const { return words_[kind / kinds_per_word].data(); }
  /// All words: for other ranks and for files to fill.
  std::vector<Words> &storage() { return words_; }
  static constexpr Word bit(std::size_t kind) { return static_cast<Word>(1u << kind % kinds_per_word); }
  static constexpr Word toughened_bit(std::size_t kind) { return static_cast<Word>(0x100u << kind % kinds_per_word); }

private:
  bool has(std::size_t place, std::size_t kind, Word mask) const
  {
    return kind < n_kinds() && (words_[kind / kinds_per_word][place] & mask) != 0;
  }

  std::size_t n_kinds_ = 0;
  std::vector<Words> words_;
};

} // namespace latcon::lattice
