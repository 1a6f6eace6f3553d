# What stands at the head of a header, for Doxygen: `#pragma once` and the lines of // below it become the file's own
# documentation. No line moves.
1s|^#pragma once$|/// @file|
2,/^\([^/]\|$\)/s|^//\( \|$\)|///\1|
