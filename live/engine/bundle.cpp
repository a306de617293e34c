// Interface of the live page's engine for the browser.
#include <emscripten/emscripten.h>

#include <string>

#include "live/engine/engine.h"

/// Returns the answer to a request. The pointer is valid until the next call.
extern "C" EMSCRIPTEN_KEEPALIVE const char* retrace_call(const char* request) {
  static retrace::live::Engine engine;
  static std::string answer;
  answer = engine.call(request);
  return answer.c_str();
}
