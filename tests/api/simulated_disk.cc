#include "simulated_disk.h"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

namespace slipway::api::testing {

// A file as a connection has it open; SQLite owns the memory.
struct OpenFile {
  sqlite3_file base{};
  std::shared_ptr<DiskFile> file;
  int process = 0;
  int lock = SQLITE_LOCK_NONE;
  std::array<int, SQLITE_SHM_NLOCK> shared{};  // 0, SQLITE_SHM_SHARED or SQLITE_SHM_EXCLUSIVE
  bool maps = false;
};

namespace {

SimulatedDisk* disk = nullptr;

void make(std::string& bytes, const DiskFile::Change& change) {
  if (change.cuts) return bytes.resize(change.at);
  if (bytes.size() < change.at + change.bytes.size()) bytes.resize(change.at + change.bytes.size());
  bytes.replace(change.at, change.bytes.size(), change.bytes);
}

OpenFile& of(sqlite3_file* file) {
  return *reinterpret_cast<OpenFile*>(file);
}

// Those of processes that live, but this one.
template <class Holds>
bool another(const OpenFile& file, const Holds& holds) {
  return std::any_of(file.file->open.begin(), file.file->open.end(), [&](const OpenFile* other) {
    return other != &file && !disk->is_dead(other->process) && holds(*other);
  });
}

int called(sqlite3_file* file, int failure, bool writes = false) {
  bool full = false;
  if (disk->may_call(of(file).process, writes, full)) return SQLITE_OK;
  return full ? SQLITE_FULL : failure;
}

int close_file(sqlite3_file* base) {
  OpenFile& file = of(base);
  std::erase(file.file->open, &file);
  if (!another(file, [](const OpenFile& other) { return other.maps; })) file.file->forget_shared_memory();
  file.~OpenFile();
  return SQLITE_OK;
}

int read_file(sqlite3_file* base, void* to, int count, sqlite3_int64 at) {
  if (const int code = called(base, SQLITE_IOERR_READ); code != SQLITE_OK) return code;
  const std::string& bytes = of(base).file->now;
  const auto from = std::min(static_cast<std::size_t>(at), bytes.size());
  const auto got = std::min(static_cast<std::size_t>(count), bytes.size() - from);
  std::memcpy(to, bytes.data() + from, got);
  if (got == static_cast<std::size_t>(count)) return SQLITE_OK;
  std::memset(static_cast<char*>(to) + got, 0, static_cast<std::size_t>(count) - got);
  return SQLITE_IOERR_SHORT_READ;
}

int write_file(sqlite3_file* base, const void* from, int count, sqlite3_int64 at) {
  const int code = called(base, SQLITE_IOERR_WRITE, true);
  DiskFile::Change change{static_cast<std::size_t>(at),
                          {static_cast<const char*>(from), static_cast<std::size_t>(count)}};
  // A write that fails may have been made in part.
  if (code != SQLITE_OK) change.bytes.resize(disk->chance()() % change.bytes.size());
  if (code == SQLITE_OK || !disk->is_dead(of(base).process)) of(base).file->change(std::move(change));
  return code;
}

int truncate_file(sqlite3_file* base, sqlite3_int64 size) {
  if (const int code = called(base, SQLITE_IOERR_TRUNCATE); code != SQLITE_OK) return code;
  of(base).file->change({static_cast<std::size_t>(size), {}, true});
  return SQLITE_OK;
}

int sync_file(sqlite3_file* base, int /*flags*/) {
  if (const int code = called(base, SQLITE_IOERR_FSYNC); code != SQLITE_OK) return code;
  of(base).file->sync();
  return SQLITE_OK;
}

int size_of_file(sqlite3_file* base, sqlite3_int64* size) {
  *size = static_cast<sqlite3_int64>(of(base).file->now.size());
  return called(base, SQLITE_IOERR_FSTAT);
}

int lock_file(sqlite3_file* base, int level) {
  OpenFile& file = of(base);
  if (disk->is_dead(file.process)) return SQLITE_IOERR_LOCK;
  if (file.lock >= level) return SQLITE_OK;
  const int most_of_others = level == SQLITE_LOCK_SHARED     ? SQLITE_LOCK_RESERVED
                             : level == SQLITE_LOCK_RESERVED ? SQLITE_LOCK_SHARED
                                                             : SQLITE_LOCK_NONE;
  if (another(file, [&](const OpenFile& other) { return other.lock > most_of_others; })) return SQLITE_BUSY;
  file.lock = level;
  return SQLITE_OK;
}

int unlock_file(sqlite3_file* base, int level) {
  of(base).lock = std::min(of(base).lock, level);
  return SQLITE_OK;
}

int is_reserved(sqlite3_file* base, int* answer) {
  *answer = of(base).lock >= SQLITE_LOCK_RESERVED ||
            another(of(base), [](const OpenFile& other) { return other.lock >= SQLITE_LOCK_RESERVED; });
  return SQLITE_OK;
}

int control(sqlite3_file* /*file*/, int /*what*/, void* /*value*/) {
  return SQLITE_NOTFOUND;
}

int sector_size(sqlite3_file* /*file*/) {
  return 4096;
}

int characteristics(sqlite3_file* /*file*/) {
  return SQLITE_IOCAP_POWERSAFE_OVERWRITE;
}

int map_shared(sqlite3_file* base, int page, int size, int extend, void volatile** to) {
  OpenFile& file = of(base);
  if (disk->is_dead(file.process)) return SQLITE_IOERR_SHMMAP;
  file.maps = true;
  auto& pages = file.file->shared_memory;
  const auto wanted = static_cast<std::size_t>(page);
  *to = nullptr;
  if (wanted >= pages.size() && extend == 0) return SQLITE_OK;
  while (wanted >= pages.size())
    pages.push_back(std::make_unique<std::array<char, 32768>>(std::array<char, 32768>{}));
  if (static_cast<std::size_t>(size) > pages[wanted]->size()) return SQLITE_IOERR_SHMSIZE;
  *to = pages[wanted]->data();
  return SQLITE_OK;
}

int lock_shared(sqlite3_file* base, int first, int count, int flags) {
  OpenFile& file = of(base);
  if (disk->is_dead(file.process)) return SQLITE_IOERR_SHMLOCK;
  const int wanted =
      (flags & SQLITE_SHM_UNLOCK) != 0 ? 0 : flags & (SQLITE_SHM_SHARED | SQLITE_SHM_EXCLUSIVE);
  for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(first + count); ++k)
    if (wanted != 0 && another(file, [&](const OpenFile& other) {
          return wanted == SQLITE_SHM_EXCLUSIVE ? other.shared[k] != 0
                                                : other.shared[k] == SQLITE_SHM_EXCLUSIVE;
        }))
      return SQLITE_BUSY;
  for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(first + count); ++k)
    file.shared[k] = wanted;
  return SQLITE_OK;
}

void barrier(sqlite3_file* /*file*/) {}

int unmap_shared(sqlite3_file* base, int /*remove*/) {
  of(base).shared = {};
  of(base).maps = false;
  return SQLITE_OK;
}

const sqlite3_io_methods kMethods{2,         close_file,   read_file,       write_file,  truncate_file,
                                  sync_file, size_of_file, lock_file,       unlock_file, is_reserved,
                                  control,   sector_size,  characteristics, map_shared,  lock_shared,
                                  barrier,   unmap_shared, nullptr,         nullptr};

int open_file(sqlite3_vfs* /*vfs*/, const char* name, sqlite3_file* base, int flags, int* out_flags) {
  base->pMethods = nullptr;
  bool full = false;
  if (!disk->may_call(disk->process(), false, full)) return SQLITE_CANTOPEN;
  const bool may_make = (flags & SQLITE_OPEN_CREATE) != 0;
  auto found = name == nullptr ? std::make_shared<DiskFile>() : disk->find(name, may_make);
  if (!found) return SQLITE_CANTOPEN;
  auto* const file = new (base) OpenFile;
  file->base.pMethods = &kMethods;
  file->file = std::move(found);
  file->process = disk->process();
  file->file->open.push_back(file);
  if (out_flags != nullptr) *out_flags = flags;
  return SQLITE_OK;
}

int delete_file(sqlite3_vfs* /*vfs*/, const char* name, int /*sync*/) {
  bool full = false;
  if (!disk->may_call(disk->process(), false, full)) return SQLITE_IOERR_DELETE;
  if (!disk->exists(name)) return SQLITE_IOERR_DELETE_NOENT;
  disk->remove(name);
  return SQLITE_OK;
}

int access_file(sqlite3_vfs* /*vfs*/, const char* name, int flags, int* answer) {
  const auto file = disk->find(name, false);
  *answer = file && (flags != SQLITE_ACCESS_EXISTS || !file->now.empty());
  return SQLITE_OK;
}

int full_name(sqlite3_vfs* /*vfs*/, const char* name, int most, char* out) {
  sqlite3_snprintf(most, out, "%s", name);
  return SQLITE_OK;
}

int randomness(sqlite3_vfs* /*vfs*/, int count, char* out) {
  for (int k = 0; k < count; ++k) out[k] = static_cast<char>(disk->chance()() & 0xffU);
  return count;
}

int no_sleep(sqlite3_vfs* /*vfs*/, int microseconds) {
  return microseconds;
}

sqlite3_vfs& simulated() {
  static sqlite3_vfs vfs = [] {
    sqlite3_initialize();
    sqlite3_vfs made = *sqlite3_vfs_find(nullptr);
    made.szOsFile = sizeof(OpenFile);
    made.zName = "simulated";
    made.xOpen = open_file;
    made.xDelete = delete_file;
    made.xAccess = access_file;
    made.xFullPathname = full_name;
    made.xRandomness = randomness;
    made.xSleep = no_sleep;
    return made;
  }();
  return vfs;
}

}  // namespace

void DiskFile::change(Change change) {
  make(now, change);
  unsynced.push_back(std::move(change));
}

void DiskFile::sync() {
  for (const Change& change : unsynced) make(durable, change);
  unsynced.clear();
}

void DiskFile::lose(std::mt19937_64& chance) {
  for (Change& change : unsynced) {
    const auto fate = chance() % 4;  // half of all are whole
    if (fate == 0) continue;
    if (fate == 1 && !change.cuts) change.bytes.resize(chance() % (change.bytes.size() + 1));
    make(durable, change);
  }
  unsynced.clear();
  now = durable;
  forget_shared_memory();
}

void DiskFile::forget_shared_memory() {
  for (auto& page : shared_memory) forgotten.push_back(std::move(page));
  shared_memory.clear();
}

SimulatedDisk::SimulatedDisk(std::uint64_t seed) : chance_(seed) {
  disk = this;
  sqlite3_vfs_register(&simulated(), 1);
  sqlite3_randomness(0, nullptr);  // so that it is drawn anew, from ours
}

SimulatedDisk::~SimulatedDisk() {
  sqlite3_vfs_unregister(&simulated());
  sqlite3_randomness(0, nullptr);
  disk = nullptr;
}

void SimulatedDisk::arm(Mishap fault, int after) {
  armed_ = fault;
  struck_ = Mishap::kNone;
  calls_left_ = after;
}

SimulatedDisk::Mishap SimulatedDisk::rest() {
  armed_ = Mishap::kNone;
  return std::exchange(struck_, Mishap::kNone);
}

bool SimulatedDisk::may_call(int process, bool writes, bool& full) {
  if (is_dead(process)) return false;
  if (armed_ == Mishap::kNone || calls_left_-- > 0) return true;
  full = armed_ == Mishap::kFull;
  if (full && !writes) return true;
  struck_ = armed_;
  if (armed_ == Mishap::kError) armed_ = Mishap::kNone;
  if (armed_ == Mishap::kDeath) die(process);
  if (armed_ == Mishap::kPower) lose_power();
  return false;
}

std::shared_ptr<DiskFile> SimulatedDisk::find(const std::string& path, bool make) {
  const auto found = files_.find(path);
  if (found != files_.end()) return found->second;
  return make ? files_[path] = std::make_shared<DiskFile>() : nullptr;
}

void SimulatedDisk::die(int process) {
  dead_.insert(process);
  armed_ = Mishap::kNone;
  for (auto& [path, file] : files_) {
    const bool lives = std::any_of(file->open.begin(), file->open.end(), [&](const OpenFile* open) {
      return open->maps && !is_dead(open->process);
    });
    if (!lives) file->forget_shared_memory();
  }
}

void SimulatedDisk::lose_power() {
  for (int process = 1; process <= last_process_; ++process) dead_.insert(process);
  armed_ = Mishap::kNone;
  for (auto& [path, file] : files_) file->lose(chance_);
}

void SimulatedDisk::rot(const std::string& path) {
  const auto file = find(path, false);
  if (!file || file->now.empty()) return;
  const std::size_t at = chance_() % file->now.size();
  const char bit = static_cast<char>(1U << (chance_() % 8));
  file->now[at] = static_cast<char>(file->now[at] ^ bit);
  file->sync();
  file->durable = file->now;
}

}  // namespace slipway::api::testing
