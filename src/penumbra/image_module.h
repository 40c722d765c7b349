// For programs that want the image module to be at hand by the time they need it.
#pragma once

namespace penumbra {

/// Begins to load the image module in the background, so that a later call need not wait. A program
/// that does so must not end before wait_for_image_module() has returned.
void preload_image_module();

/// Waits until what preload_image_module() began is done, if it was called. Ending the process
/// earlier would run the destructors of libraries whose constructors are still at work.
void wait_for_image_module();

}  // namespace penumbra
