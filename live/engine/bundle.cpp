// The engine of the live page as the browser calls it.
#include <emscripten/emscripten.h>

#include <string>

#include "live/engine/engine.h"

/// The answer to a request; it lasts until the next call.
extern "C" EMSCRIPTEN_KEEPALIVE const char* retrace_call(const char* request) {
  static retrace::live::Engine engine;
  static std::string answer;
  answer = engine.call(request);
  return answer.c_str();
}
