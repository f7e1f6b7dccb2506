#pragma once

namespace alcove::sample {

// Takes the standard streams that were closed when the program was started, so that no file and no
// connection opened later gets their numbers and what is printed ends up in it. Reading and writing
// them fails as before. To be called before anything is opened.
void take_closed_streams();

}  // namespace alcove::sample
