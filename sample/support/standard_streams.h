#pragma once

namespace alcove::sample {

// Opens /dev/null in place of standard streams that were closed when the program started. Otherwise
// a file or connection that is opened later would get the descriptor of such a stream and receive
// the program's output. Reading and writing the streams still fails. Call this before anything is
// opened.
void reserve_closed_streams();

}  // namespace alcove::sample
