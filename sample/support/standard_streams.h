#pragma once

namespace alcove::sample {

// Reserves the descriptors of standard streams that were closed when the program started. Otherwise
// a file or connection opened later would get such a descriptor and receive the program's output.
// Reading and writing the streams still fails. Call this before anything is opened.
void reserve_closed_streams();

}  // namespace alcove::sample
