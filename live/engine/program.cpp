// The live page's engine as a native program. It reads one request per line from standard input and writes one answer
// per line to standard output. Tests compare the engine in the browser with this program.
#include <iostream>
#include <string>

#include "live/engine/engine.h"

int main() {
  retrace::live::Engine engine;
  for (std::string request; std::getline(std::cin, request);) std::cout << engine.call(request) << std::endl;
  return 0;
}
