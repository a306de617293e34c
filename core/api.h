#pragma once

// Marks symbols that libretrace.so exports. All other symbols are hidden, so that they cannot collide with symbols of
// other libraries in the process.

#define RETRACE_API __attribute__((visibility("default")))
