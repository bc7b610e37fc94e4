// SPDX-License-Identifier: BSD-3-Clause
/// A small importer of FMI 3.0: loads a unit's library, does the calls that lines of standard input name, one a line,
/// and answers each with a line: its status, then values as hexadecimal floating-point numbers. The unit's messages go
/// to standard error.
///
///   fmu_importer LIBRARY TOKEN RESOURCES
///
///   new I [EVENTS] | free I | enter I START STOP | exit I | terminate I | reset I | step I TIME LENGTH [TIMES]
///   get I TYPE REFERENCE COUNT | set I TYPE REFERENCE COUNT VALUE ...    TYPE: Float64, Int32, Boolean, String
///   keep I S | restore I S | drop I S | call I NAME                       I, S: 0 ... 7; STOP: nan where there is none
///   save I S FILE | load I S FILE: the state as bytes; save says where a byte more or less is not refused
///   allocations I: how often memory was asked for in steps so far | logging I ON CATEGORY
///
/// Invalid operations of floating-point numbers trap in steps and at the end of the initialisation.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fenv.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef int Status;
typedef uint32_t Reference;
typedef void (*Log)(void* environment, Status status, const char* category, const char* message);

enum
{
  SLOTS = 8,
  MOST = 4096
};

static void* library;
static bool steps_now;
static unsigned long allocations;

// NOLINTBEGIN(readability-identifier-naming): the C library's names
void* __libc_malloc(size_t size);

/// In place of the C library's, for the unit too; operator new ends here.
void* malloc(size_t size)
{
  allocations += steps_now;
  return __libc_malloc(size);
}
// NOLINTEND(readability-identifier-naming)

static void* function(const char* name)
{
  void* found = dlsym(library, name);
  if (found == NULL)
  {
    fprintf(stderr, "no function %s\n", name);
    exit(2);
  }
  return found;
}

static void logMessage(void* environment, Status status, const char* category, const char* message)
{
  fprintf(stderr, "%s %d %s %s\n", (const char*)environment, status, category, message);
}

static void* instantiate(const char* token, const char* resources, bool events)
{
  void* (*make)(const char*, const char*, const char*, bool, bool, bool, bool, const Reference*, size_t, void*, Log,
                void*) = function("fmi3InstantiateCoSimulation");
  return make("drive", token, resources, false, true, events, false, NULL, 0, "drive", logMessage, NULL);
}

static Status get(void* instance, const char* type, Reference reference, size_t count)
{
  static double numbers[MOST];
  static int32_t wholes[MOST];
  static bool truths[MOST];
  static const char* texts[MOST];
  char name[32];
  snprintf(name, sizeof name, "fmi3Get%s", type);
  Status (*call)(void*, const Reference*, size_t, void*, size_t) = function(name);
  void* values = strcmp(type, "Float64") == 0 ? (void*)numbers :
                 strcmp(type, "Int32") == 0   ? (void*)wholes :
                 strcmp(type, "Boolean") == 0 ? (void*)truths :
                                                (void*)texts;
  const Status status = call(instance, &reference, 1, values, count);
  printf("%d", status);
  for (size_t i = 0; status == 0 && i < count; ++i)
  {
    values == texts ? printf(" %s", texts[i]) :
                      printf(" %a", values == numbers ? numbers[i] :
                                    values == wholes  ? wholes[i] :
                                                        truths[i]);
  }
  return status;
}

static Status set(void* instance, const char* type, Reference reference, size_t count)
{
  double numbers[MOST];
  int32_t wholes[MOST];
  bool truths[MOST];
  const char* texts[MOST];
  for (size_t i = 0; i < count; ++i)
  {
    texts[i] = strtok(NULL, " \n");
    numbers[i] = strtod(texts[i], NULL);
    wholes[i] = (int32_t)numbers[i];
    truths[i] = numbers[i] != 0.0;
  }
  char name[32];
  snprintf(name, sizeof name, "fmi3Set%s", type);
  Status (*call)(void*, const Reference*, size_t, const void*, size_t) = function(name);
  const void* values = strcmp(type, "Float64") == 0 ? (const void*)numbers :
                       strcmp(type, "Int32") == 0   ? (const void*)wholes :
                       strcmp(type, "Boolean") == 0 ? (const void*)truths :
                                                      (const void*)texts;
  return call(instance, &reference, 1, values, count);
}

static double number(void)
{
  return strtod(strtok(NULL, " \n"), NULL);
}

static Status step(void* instance)
{
  Status (*call)(void*, double, double, bool, bool*, bool*, bool*, double*) = function("fmi3DoStep");
  const double from = number();
  const double length = number();
  const char* times = strtok(NULL, " \n");
  const int steps = times != NULL ? atoi(times) : 1;
  Status status = 0;
  for (int i = 0; status == 0 && i < steps; ++i)
  {
    bool event = true;
    bool terminated = true;
    bool early = true;
    double last = NAN;
    steps_now = true;
    feenableexcept(FE_INVALID | FE_DIVBYZERO);
    status = call(instance, from + i * length, length, true, &event, &terminated, &early, &last);
    const bool traps = fedisableexcept(FE_ALL_EXCEPT) == (FE_INVALID | FE_DIVBYZERO);
    steps_now = false;
    if (!traps || (status == 0 && (event || terminated || early || fabs(last - (from + (i + 1) * length)) > 1e-12)))
    {
      printf("wrong results of fmi3DoStep ");
    }
  }
  return status;
}

/// A command that calls one function of the instance.
static Status callNamed(const char* command, void* instance)
{
  const char* name = strcmp(command, "exit") == 0      ? "fmi3ExitInitializationMode" :
                     strcmp(command, "terminate") == 0 ? "fmi3Terminate" :
                     strcmp(command, "reset") == 0     ? "fmi3Reset" :
                                                         strtok(NULL, " \n");
  Status (*call)(void*) = function(name);
  feenableexcept(FE_INVALID | FE_DIVBYZERO);
  const Status status = call(instance);
  fedisableexcept(FE_ALL_EXCEPT);
  return status;
}

static Status callWithState(const char* command, void* instance, void** state)
{
  if (command[0] == 'r')
  {
    Status (*restore)(void*, void*) = function("fmi3SetFMUState");
    return restore(instance, *state);
  }
  Status (*call)(void*, void**) = function(command[0] == 'k' ? "fmi3GetFMUState" : "fmi3FreeFMUState");
  return call(instance, state);
}

static Status save(void* instance, void* state, const char* path)
{
  Status (*ask)(void*, void*, size_t*) = function("fmi3SerializedFMUStateSize");
  Status (*call)(void*, void*, uint8_t*, size_t) = function("fmi3SerializeFMUState");
  size_t size = 0;
  Status status = ask(instance, state, &size);
  uint8_t* bytes = malloc(size + 1);
  FILE* file = status == 0 ? fopen(path, "wb") : NULL;
  if (file != NULL)
  {
    if (call(instance, state, bytes, size - 1) == 0 || call(instance, state, bytes, size + 1) == 0)
    {
      printf("another size is taken ");
    }
    status = call(instance, state, bytes, size);
    fwrite(bytes, 1, size, file);
    fclose(file);
  }
  free(bytes);
  return status;
}

static Status load(void* instance, void** state, const char* path)
{
  static uint8_t bytes[1 << 22];
  Status (*call)(void*, const uint8_t*, size_t, void**) = function("fmi3DeserializeFMUState");
  FILE* file = fopen(path, "rb");
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  uint8_t* exact = malloc(size);  // so that a memory checker sees what is read behind
  memcpy(exact, bytes, size);
  const Status status = call(instance, exact, size, state);
  free(exact);
  return status;
}

static Status enter(void* instance)
{
  Status (*call)(void*, bool, double, double, bool, double) = function("fmi3EnterInitializationMode");
  const double start = number();
  const double stop = number();
  return call(instance, false, 0.0, start, !isnan(stop), stop);
}

/// A command that answers with its status alone.
static Status run(const char* command, char** argv, void** instance, void** states)
{
  if (strcmp(command, "new") == 0)
  {
    *instance = instantiate(argv[2], argv[3], strtok(NULL, " \n") != NULL);
    return *instance == NULL;
  }
  if (strcmp(command, "free") == 0)
  {
    void (*call)(void*) = function("fmi3FreeInstance");
    call(*instance);
    *instance = NULL;
    return 0;
  }
  if (strcmp(command, "enter") == 0)
  {
    return enter(*instance);
  }
  if (strcmp(command, "step") == 0)
  {
    return step(*instance);
  }
  if (strcmp(command, "logging") == 0)
  {
    Status (*call)(void*, bool, size_t, const char* const*) = function("fmi3SetDebugLogging");
    const bool on = number() != 0.0;
    const char* category = strtok(NULL, " \n");
    return call(*instance, on, 1, &category);
  }
  if (strcmp(command, "set") == 0)
  {
    const char* type = strtok(NULL, " \n");
    const Reference reference = (Reference)number();
    return set(*instance, type, reference, (size_t)number());
  }
  if (strcmp(command, "keep") == 0 || strcmp(command, "drop") == 0 || strcmp(command, "restore") == 0)
  {
    return callWithState(command, *instance, &states[(int)number()]);
  }
  if (strcmp(command, "save") == 0 || strcmp(command, "load") == 0)
  {
    void** state = &states[(int)number()];
    const char* path = strtok(NULL, "\n");
    return command[0] == 's' ? save(*instance, *state, path) : load(*instance, state, path);
  }
  return callNamed(command, *instance);
}

int main(int argc, char** argv)
{
  static char line[1 << 16];
  void* instances[SLOTS] = { NULL };
  void* states[SLOTS] = { NULL };
  library = argc == 4 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;
  if (library == NULL)
  {
    fprintf(stderr, "%s\n", argc == 4 ? dlerror() : "usage: fmu_importer LIBRARY TOKEN RESOURCES");
    return 2;
  }
  const char* (*version)(void) = function("fmi3GetVersion");
  setvbuf(stdout, NULL, _IOLBF, 0);
  printf("%s\n", version());
  while (fgets(line, sizeof line, stdin) != NULL)
  {
    const char* command = strtok(line, " \n");
    const int i = (int)number();
    if (strcmp(command, "allocations") == 0)
    {
      printf("%lu\n", allocations);
    }
    else if (strcmp(command, "get") == 0)
    {
      const char* type = strtok(NULL, " \n");
      const Reference reference = (Reference)number();
      get(instances[i], type, reference, (size_t)number());
      printf("\n");
    }
    else
    {
      printf("%d\n", run(command, argv, &instances[i], states));
    }
  }
  return 0;
}
