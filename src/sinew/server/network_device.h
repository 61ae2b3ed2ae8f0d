// A haptic device that speaks WebSocket. docs/haptics.md, "A device over the network".
#pragma once

#include <sinew/haptics.h>

#include <memory>
#include <string>

namespace sinew::server {

// Listens on this machine. One device at a time: a second one is turned away. Each message of the
// device, {"position": [x, y, z], "rotation": [w, x, y, z], "button": false} (the last two may be
// left out), sets the input; the answer is the newest force, {"force": [x, y, z], "torque":
// [x, y, z]}. A message that is not that gets {"error": "..."} and changes nothing.
// Before the first message, and after the device has left, the input is the last one, and
// connected() says so. read() and write() take no lock.
class NetworkDevice final : public HapticDevice {
 public:
  // Port 0: a free one. Error(io) if the port is taken.
  explicit NetworkDevice(unsigned short port);
  ~NetworkDevice() override;

  unsigned short port() const;
  bool connected() const;
  HapticInput read(double dt) override;
  void write(const Wrench& wrench) override;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

// The input that a message states; Error(input) with what is wrong.
HapticInput read_haptic_input(const std::string& message);

}  // namespace sinew::server
