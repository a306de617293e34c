// The engine of the live page as a native program: a request a line of standard input, an answer a line of standard
// output. What the bundle in the browser says is held against it.
#include <iostream>
#include <string>

#include "live/engine/engine.h"

int main() {
  retrace::live::Engine engine;
  for (std::string request; std::getline(std::cin, request);) std::cout << engine.call(request) << std::endl;
  return 0;
}
