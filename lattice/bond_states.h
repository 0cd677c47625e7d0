#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/triangular_lattice.h"
#include "lattice/zero_pages.h"

namespace latcon::lattice
{

/// Bonds that are present and bonds that are toughened, two bits per bond: one word for the six bonds that start at a
/// place, with the present kinds in the lower byte and the toughened kinds in the upper one.
class BondStates
{
public:
  using Word = std::uint16_t;
  using Words = std::vector<Word, ZeroPages<Word>>;

  /// No bonds at all at n places.
  void clear(std::size_t n) { words_ = Words(n); }

  bool present(std::size_t place, std::size_t kind) const { return (words_[place] & bit(kind)) != 0; }
  bool toughened(std::size_t place, std::size_t kind) const { return (words_[place] & toughened_bit(kind)) != 0; }

  /// Makes a bond present, and not toughened.
  void add(std::size_t place, std::size_t kind)
  {
    remove(place, kind);
    words_[place] = static_cast<Word>(words_[place] | bit(kind));
  }
  void remove(std::size_t place, std::size_t kind)
  {
    words_[place] = static_cast<Word>(words_[place] & ~(bit(kind) | toughened_bit(kind)));
  }
  /// Toughens a bond that is present.
  void toughen(std::size_t place, std::size_t kind)
  {
    words_[place] = static_cast<Word>(words_[place] | toughened_bit(kind));
  }

  const Word *words() const { return words_.data(); } ///< one a place
  Words &storage() { return words_; }                 ///< for other ranks to fill
  static constexpr Word bit(std::size_t kind) { return static_cast<Word>(1u << kind); }
  static constexpr Word toughened_bit(std::size_t kind) { return static_cast<Word>(0x100u << kind); }

private:
  Words words_;
};

} // namespace latcon::lattice
