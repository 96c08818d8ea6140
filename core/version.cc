#include "core/version.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <cstring>

namespace slipway {
namespace {

std::string hexadecimal(const unsigned char* bytes, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += fmt::format("{:02x}", bytes[i]);
  return text;
}

// The build id among the notes of a segment; empty where there is none. A note is a header, a name and a
// description, each filled up to the segment's alignment (ELF specification, "Note Section").
std::string build_id_among(const unsigned char* notes, std::size_t size, std::size_t alignment) {
  const auto filled = [&](std::size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; };
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) note{};
    std::memcpy(&note, notes + at, sizeof note);
    const std::size_t name = at + sizeof note, description = name + filled(note.n_namesz);
    const bool is_gnu = note.n_namesz == sizeof ELF_NOTE_GNU &&
                        std::memcmp(notes + name, ELF_NOTE_GNU, sizeof ELF_NOTE_GNU) == 0;
    if (is_gnu && note.n_type == NT_GNU_BUILD_ID) return hexadecimal(notes + description, note.n_descsz);
    at = description + filled(note.n_descsz);
  }
  return {};
}

// The first that the loader names is the program itself; libraries follow.
int read_build_id(dl_phdr_info* program, std::size_t /*size*/, void* found) {
  constexpr std::size_t kUsual = 4, kWide = 8;
  for (int i = 0; i < program->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = program->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const auto* notes = reinterpret_cast<const unsigned char*>(program->dlpi_addr + segment.p_vaddr);
    std::string id = build_id_among(notes, segment.p_memsz, segment.p_align == kWide ? kWide : kUsual);
    if (!id.empty()) *static_cast<std::string*>(found) = std::move(id);
  }
  return 1;
}

}  // namespace

std::string_view version() {
  return SLIPWAY_VERSION;
}

const std::string& build_id() {
  static const std::string id = [] {
    std::string found;
    ::dl_iterate_phdr(read_build_id, &found);
    return found.empty() ? std::string(version()) : found;
  }();
  return id;
}

}  // namespace slipway
