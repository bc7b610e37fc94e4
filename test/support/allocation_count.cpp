// SPDX-License-Identifier: BSD-3-Clause
#include "allocation_count.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace
{
std::atomic<std::size_t> g_allocations{ 0 };

void count() noexcept
{
  g_allocations.fetch_add(1, std::memory_order_relaxed);
}
}  // namespace

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// A sanitizer has replaced these functions itself and reports their calls.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void* memory,
                                                                           std::size_t size),
                                                         void (*freed)(const volatile void* memory));  // NOLINT

namespace
{
const int G_HOOKS = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void* /*memory*/, std::size_t /*size*/) { count(); }, [](const volatile void* /*memory*/) {});
}  // namespace
#else
// The GNU C library's own functions, under the names it keeps for those who replace the public ones.
// NOLINTBEGIN(readability-identifier-naming)
extern "C"
{
  void* __libc_malloc(std::size_t size);
  void* __libc_calloc(std::size_t count, std::size_t size);
  void* __libc_realloc(void* memory, std::size_t size);
  void* __libc_memalign(std::size_t alignment, std::size_t size);
}
// NOLINTEND(readability-identifier-naming)

extern "C"
{
  void* malloc(std::size_t size) noexcept
  {
    count();
    return __libc_malloc(size);
  }

  void* calloc(std::size_t number, std::size_t size) noexcept
  {
    count();
    return __libc_calloc(number, size);
  }

  void* realloc(void* memory, std::size_t size) noexcept
  {
    count();
    return __libc_realloc(memory, size);
  }

  void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept
  {
    count();
    return __libc_memalign(alignment, size);
  }

  int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept
  {
    count();
    *memory = __libc_memalign(alignment, size);
    return *memory == nullptr ? ENOMEM : 0;
  }
}
#endif

std::size_t hjt::allocationCount() noexcept
{
  return g_allocations.load(std::memory_order_relaxed);
}
