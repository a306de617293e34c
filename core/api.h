#pragma once

// What libretrace.so shows of itself. All else is hidden, so that it cannot collide with what else a process has.

#define RETRACE_API __attribute__((visibility("default")))
