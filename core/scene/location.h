#pragma once
// A place in a file.

namespace momenta {

/// A place in a file; line 0: the thing is not from a file.
struct Location {
  int line = 0;    ///< from 1
  int column = 0;  ///< from 1, in characters; 0: not known
  int file = 0;    ///< 0: Scene::file; from 1: the files of Scene::included
};

}  // namespace momenta
