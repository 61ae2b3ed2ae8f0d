// The live view of a simulation: its scene and state in a server on two other threads.
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "module.h"
#include "simulation.h"
#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/server/guard.h"
#include "sinew/server/server.h"

namespace sinew::python {
namespace {

class View {
 public:
  View(PySimulation& simulation, unsigned short port, bool framed) : simulation_(simulation) {
    simulation.require_own();
    sim::World& world = sim::internals(simulation.lent());
    server::Options options;
    options.port = port;
    options.framed = framed;
    if (framed) options.token = server::make_token();  // other pages of the machine do not know it
    options.state = simulation.lent().save();
    const Scene scene = world.current_scene();
    CtrlC ctrl_c;
    try {
      const CancelScope scope(*ctrl_c.stop());
      const py::gil_scoped_release unlock;
      server_ = std::make_unique<server::Server>(options, scene);
    } catch (const Cancelled&) {
    }
    ctrl_c.finish();
    thread_ = std::thread([this] { server_->run(); });
    simulation_.shown = true;
  }
  ~View() { end(); }
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  std::string url() const { return server_ ? server_->url() : std::string(); }
  bool open() const { return server_ != nullptr; }

  // Ends the server. The simulation goes on from the state that the view shows.
  void close() {
    if (!server_) return;
    CtrlC ctrl_c;
    std::string bytes;
    {
      const py::gil_scoped_release unlock;
      bytes = take(*ctrl_c.stop());
      if (!ctrl_c.stop()->load()) end();
    }
    ctrl_c.finish();  // the view stays open
    if (bytes.empty())
      throw Error(ErrorKind::usage, "the view did not give its state back in time",
                  "the simulation keeps the state that it had before view()");
    try {
      simulation_.lent().restore(SavedState(bytes));
    } catch (const Error&) {
      throw Error(ErrorKind::usage, "the view shows another scene or material by now",
                  "the simulation keeps the state that it had before view()");
    }
    sim::internals(simulation_.lent()).choose_steps();
    simulation_.changed();
  }

 private:
  // Empty: no answer, such as while another scene is opened.
  std::string take(const std::atomic<bool>& stop) {
    auto promise = std::make_shared<std::promise<std::string>>();
    std::future<std::string> state = promise->get_future();
    server_->runner().post(
        live::HandBack{[promise](std::string bytes) { promise->set_value(std::move(bytes)); }});
    constexpr std::chrono::milliseconds a_moment(50);
    for (int moments = 200; moments > 0 && !stop; --moments)
      if (state.wait_for(a_moment) == std::future_status::ready) return state.get();
    return {};
  }

  void end() {
    if (!server_) return;
    server_->stop();
    thread_.join();
    server_.reset();
    simulation_.shown = false;
  }

  PySimulation& simulation_;
  std::unique_ptr<server::Server> server_;
  std::thread thread_;
};

}  // namespace

void add_view(py::module_& m) {
  py::class_<View>(m, "View")
      .def(py::init<PySimulation&, unsigned short, bool>(), py::arg("simulation"), py::arg("port"),
           py::arg("framed"), py::keep_alive<1, 2>())
      .def_property_readonly("url", &View::url)
      .def_property_readonly("open", &View::open)
      .def("close", &View::close);
}

}  // namespace sinew::python
