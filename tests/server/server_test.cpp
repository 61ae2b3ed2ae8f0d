#include "sinew/server/server.h"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/server/protocol.h"
#include "tests/live/support.h"
#include "tests/server/client.h"
#include "tests/support/source_dir.h"

namespace sinew::server {
namespace {

using test::Client;

class ServerTest : public testing::Test {
 protected:
  void start(Options options = {}) {
    server_ = std::make_unique<Server>(options, test::hanging_box());
    thread_ = std::thread([this] { server_->run(); });
  }
  void SetUp() override { start(); }
  void TearDown() override { stop(); }
  void stop() {
    if (!thread_.joinable()) return;
    server_->stop();
    thread_.join();
    server_.reset();
  }
  unsigned short port() const { return server_->port(); }

  // Whether the simulation still does what it is told.
  void expect_alive() {
    Client c(port());
    ASSERT_NE(c.shake().find("101"), std::string::npos);
    ASSERT_TRUE(c.hear_text("\"hello\""));
    c.say(R"({"type":"control"})");
    ASSERT_TRUE(c.hear_text("\"controls\":true"));
    c.say(R"({"type":"step"})");
    ASSERT_TRUE(c.hear_binary(2));
  }

  std::unique_ptr<Server> server_;
  std::thread thread_;
};

TEST_F(ServerTest, ServesThePageWithItsPolicyAndNothingElse) {
  const std::string page = Client(port()).get("/");
  EXPECT_EQ(page.find("HTTP/1.1 200"), 0u);
  for (const char* part : {"text/html", "Content-Security-Policy: default-src 'none'", "nosniff",
                           "X-Frame-Options: DENY", "<!doctype html>"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_NE(Client(port()).get("/scene.toml").find("[body.box]"), std::string::npos);
  for (const char* target : {"/nothing", "/../../etc/passwd", "/live", "//", "/%2e%2e/"}) {
    EXPECT_EQ(Client(port()).get(target).find("HTTP/1.1 404"), 0u) << target;
  }
  Client post(port());
  post.send("POST / HTTP/1.1\r\nHost: " + post.own_host() + "\r\nContent-Length: 0\r\n\r\n");
  EXPECT_NE(post.read_until("\r\n").find("405"), std::string::npos);
}

TEST_F(ServerTest, ForeignNamesAndPagesAreKeptOut) {
  const std::string port_text = std::to_string(port());
  EXPECT_EQ(Client(port()).get("/", "evil.example:" + port_text).find("HTTP/1.1 403"), 0u);
  EXPECT_NE(Client(port()).shake("/live", "Origin: http://evil.example\r\n").find("403"),
            std::string::npos);
  EXPECT_NE(Client(port()).shake("/live", "", "evil.example").find("403"), std::string::npos);
  EXPECT_NE(Client(port()).shake("/other").find("403"), std::string::npos);
  EXPECT_NE(
      Client(port()).shake("/live", "Origin: http://127.0.0.1:" + port_text + "\r\n").find("101"),
      std::string::npos);
}

TEST_F(ServerTest, ATokenIsNeededWhereThereIsOne) {
  stop();
  Options options;
  options.token = "0123456789abcdef";
  start(options);
  EXPECT_EQ(Client(port()).get("/").find("HTTP/1.1 403"), 0u);
  EXPECT_EQ(Client(port()).get("/?token=0123456789abcdee").find("HTTP/1.1 403"), 0u);
  EXPECT_EQ(Client(port()).get("/?token=0123456789abcdef").find("HTTP/1.1 200"), 0u);
  EXPECT_NE(Client(port()).shake("/live").find("403"), std::string::npos);
  EXPECT_NE(Client(port()).shake("/live?token=0123456789abcdef").find("101"), std::string::npos);
  EXPECT_NE(server_->url().find("?token=0123456789abcdef"), std::string::npos);
}

TEST_F(ServerTest, TellsWhatThereIsThenStreamsFramesWhileItRuns) {
  Client c(port());
  ASSERT_NE(c.shake().find("101"), std::string::npos);
  const auto hello = c.hear_text("");
  ASSERT_TRUE(hello);
  EXPECT_EQ(nlohmann::json::parse(*hello)["protocol"], protocol_version);
  const auto scene = c.hear_text("\"scene\"");
  ASSERT_TRUE(scene);
  EXPECT_EQ(nlohmann::json::parse(*scene)["nodes"], 64);
  ASSERT_TRUE(c.hear_binary(1));
  c.say(R"({"type":"play","running":true})");
  double time = 0.0;
  for (int i = 0; i < 20; ++i) {
    const auto frame = c.hear_binary(2);
    ASSERT_TRUE(frame);
    double now = 0.0;
    std::memcpy(&now, frame->data() + 24, 8);
    EXPECT_GE(now, time);
    time = now;
  }
  EXPECT_GT(time, 0.1);
  c.say(R"({"type":"play","running":false})");
  EXPECT_TRUE(c.hear_text("\"running\":false"));
}

TEST_F(ServerTest, OneHasTheControlsOthersWatchAndMayTakeThem) {
  Client first(port());
  Client second(port());
  first.shake();
  ASSERT_TRUE(first.hear_text("\"controls\":true"));
  second.shake();
  ASSERT_TRUE(second.hear_text("\"controls\":false,\"viewers\":2"));
  second.say(R"({"type":"play"})");
  EXPECT_TRUE(second.hear_text("another browser has the controls"));
  second.say(R"({"type":"control"})");
  EXPECT_TRUE(second.hear_text("\"controls\":true"));
  EXPECT_TRUE(first.hear_text("\"controls\":false"));
  second.close();
  EXPECT_TRUE(first.hear_text("\"controls\":true,\"viewers\":1"));
}

TEST_F(ServerTest, AHandLetsGoWhenItsBrowserIsGone) {
  Client first(port());
  first.shake();
  first.say(R"({"type":"grab","hand":0,"node":0,"point":[0,0,0]})");
  ASSERT_TRUE(first.hear_text("\"hand\":0"));
  first.close();
  Client second(port());
  second.shake();
  EXPECT_TRUE(second.hear_text("\"hands\":[]"));
}

TEST_F(ServerTest, RefusalsOfTheSimulationReachTheBrowser) {
  Client c(port());
  c.shake();
  c.say(R"({"type":"material","key":"poisson","value":0.7})");
  const auto status = c.hear_text("\"errors\":1");
  ASSERT_TRUE(status);
  EXPECT_NE(status->find("poisson"), std::string::npos);
}

TEST_F(ServerTest, HostileMessagesNeverStopIt) {
  const std::string deep(4000, '[');
  const std::vector<std::string> bad = {
      "", "{", deep, std::string("\0\0\0", 3), "{\"type\":\"x\"}", "\xff\xfe"};
  {
    Client c(port());
    c.shake();
    for (int i = 0; i < 10; ++i) c.say(bad[static_cast<std::size_t>(i) % bad.size()]);
    EXPECT_TRUE(c.hear_text("\"error\""));
    for (int i = 0; i < 40; ++i) c.say("{");
    EXPECT_TRUE(c.is_closed());
  }
  {
    Client c(port());
    c.shake();
    c.say(std::string(100000, 'x'));  // too long
    EXPECT_TRUE(c.is_closed());
  }
  {
    Client c(port());
    c.shake();
    c.say("{}", 1, false);  // not masked
    EXPECT_TRUE(c.is_closed());
  }
  {
    Client c(port());
    c.shake();
    c.send(std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\1\2\3\4", 14));  // of 2^63 bytes
    EXPECT_TRUE(c.is_closed());
  }
  {
    Client c(port());
    c.shake();
    for (int i = 0; i < 5000 && c.say(R"({"type":"seen","frame":1})"); ++i) {
    }  // a flood
    EXPECT_TRUE(c.is_closed());
  }
  for (const std::string& request :
       {std::string(100000, 'A'), std::string("GET / HTTP/1.1\r\n\r\n"), std::string("\0\1\2\3", 4),
        "GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999999\r\n\r\n" + deep,
        "GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n\r\n"}) {
    Client c(port());
    c.send(request);
    c.send("\r\n\r\n");
  }
  expect_alive();
}

TEST_F(ServerTest, ABrowserThatDoesNotReadGetsNoQueue) {
  Client idle(port());
  idle.shake();
  idle.say(R"({"type":"play"})");
  Client reader(port());
  reader.shake();
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(reader.hear_binary(2));
  // What it was sent in the meantime: two frames, and statuses.
  int frames = 0;
  idle.say(R"({"type":"play","running":false})");
  while (const auto m = idle.hear()) {
    frames += m->opcode == 2 && m->payload[6] == 2 ? 1 : 0;
    if (m->payload.find("\"running\":false") != std::string::npos &&
        m->payload.find("\"time\":0.0,") == std::string::npos) {
      break;
    }
  }
  EXPECT_LE(frames, 2);
}

TEST_F(ServerTest, AHundredConnectionsAreBounded) {
  std::vector<std::unique_ptr<Client>> clients;
  int shaken = 0;
  for (int i = 0; i < 100; ++i) {
    clients.push_back(std::make_unique<Client>(port()));
    shaken += clients.back()->shake().find("101") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(shaken, 64);
  clients.clear();
  for (int i = 0; i < 100; ++i) {  // the places become free, be it a little later
    if (Client(port()).get("/").find("200") != std::string::npos) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  expect_alive();
}

TEST_F(ServerTest, BrowsersThatComeAndGoLeaveNothingBehind) {
  for (int i = 0; i < 50; ++i) {
    Client c(port());
    c.shake();
    if (i % 2 == 0) c.say(R"({"type":"play"})");
    if (i % 3 == 0) c.hear();
  }
  expect_alive();
}

TEST_F(ServerTest, StopsWhileBrowsersAreThere) {
  Client c(port());
  c.shake();
  c.say(R"({"type":"play"})");
  ASSERT_TRUE(c.hear_binary(2));
  Client silent(port());
  ASSERT_TRUE(silent.connected());
  stop();
  EXPECT_TRUE(c.is_closed());
}

// The ticket of the viewer that has the controls.
std::string ticket_of(Client& c) {
  c.shake();
  const auto role = c.hear_text("\"controls\":true");
  return role ? nlohmann::json::parse(*role)["ticket"].get<std::string>() : "";
}

std::string give(unsigned short port, const std::string& query, const std::string& body,
                 const std::string& more = "") {
  Client c(port);
  c.send("POST /files?" + query + " HTTP/1.1\r\nHost: " + c.own_host() + "\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\nConnection: close\r\n" + more + "\r\n" + body);
  return c.read_all();
}

TEST_F(ServerTest, ScenesOfTheGalleryAreOpened) {
  stop();
  Options options;
  options.scenes = test::source_path("scenes");
  start(options);
  const std::string list = Client(port()).get("/gallery.json");
  const auto scenes = nlohmann::json::parse(list.substr(list.find("\r\n\r\n") + 4));
  EXPECT_GE(scenes.size(), 10u);
  EXPECT_NE(Client(port()).get("/gallery/../liver.toml").find("404"), std::string::npos);
  Client c(port());
  c.shake();
  c.say(R"({"type":"open","scene":"beam"})");
  ASSERT_TRUE(c.hear_text("\"opened\":2"));
  c.say(R"({"type":"open","scene":"../liver"})");
  EXPECT_TRUE(c.hear_text("no such scene"));
}

TEST_F(ServerTest, FilesOfTheViewerWithTheControlsAreOpened) {
  Client c(port());
  const std::string ticket = ticket_of(c);
  ASSERT_EQ(ticket.size(), 32u);
  const std::string scene =
      "[body.a]\nshape = \"box\"\ncells = [1, 1, 1]\n[pin.p]\nselect = {side = \"+y\"}\n";
  EXPECT_NE(give(port(), "name=a.toml&ticket=" + ticket, scene).find(" 200 "), std::string::npos);
  c.say(R"({"type":"open","file":"a.toml"})");
  ASSERT_TRUE(c.hear_text("\"opened\":2"));
  // A tetrahedron as a mesh alone.
  const std::string mesh =
      "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
      "Tetrahedra 1\n1 2 3 4 0\nEnd\n";
  EXPECT_NE(give(port(), "name=t.mesh&ticket=" + ticket, mesh).find(" 200 "), std::string::npos);
  c.say(R"({"type":"open","file":"t.mesh"})");
  ASSERT_TRUE(c.hear_text("\"opened\":3"));
  // What cannot be read is said as on the command line, and the scene stays.
  EXPECT_NE(give(port(), "name=bad.toml&ticket=" + ticket, "[body.a\nx").find(" 200 "),
            std::string::npos);
  c.say(R"({"type":"open","file":"bad.toml"})");
  const auto status = c.hear_text("bad.toml:1");
  ASSERT_TRUE(status);
  EXPECT_EQ(status->find("sinew-view-"), std::string::npos) << "as the viewer named it";
  c.say(R"({"type":"open","file":"nothing.toml"})");
  EXPECT_TRUE(c.hear_text("no such file"));
  expect_alive();
}

TEST_F(ServerTest, OtherFilesAreKeptOut) {
  Client c(port());
  const std::string ticket = ticket_of(c);
  EXPECT_NE(give(port(), "name=a.toml&ticket=0", "x").find(" 403 "), std::string::npos);
  EXPECT_NE(give(port(), "name=a.toml", "x").find(" 403 "), std::string::npos);
  EXPECT_NE(give(port(), "name=a.toml&ticket=" + ticket, "x", "Origin: http://evil.example\r\n")
                .find(" 403 "),
            std::string::npos);
  for (const char* name :
       {"", "..", "../a.toml", "a%2fb.toml", ".toml", "a.exe", "a.toml/", "toml"}) {
    EXPECT_NE(give(port(), "ticket=" + ticket + "&name=" + name, "x").find(" 400 "),
              std::string::npos)
        << name;
  }
  Client large(port());
  large.send("POST /files?name=a.toml&ticket=" + ticket + " HTTP/1.1\r\nHost: " + large.own_host() +
             "\r\nContent-Length: 99999999999\r\n\r\n");
  EXPECT_NE(large.read_until("\r\n").find(" 413 "), std::string::npos);
  {
    std::vector<std::unique_ptr<Client>> half;  // files that never end
    for (int i = 0; i < 4; ++i) {
      half.push_back(std::make_unique<Client>(port()));
      half.back()->send("POST /files?name=a.toml&ticket=" + ticket + " HTTP/1.1\r\nHost: " +
                        half.back()->own_host() + "\r\nContent-Length: 1000\r\n\r\nabc");
    }
    EXPECT_NE(half.back()->read_until("\r\n").find(" 503 "), std::string::npos);
  }
  expect_alive();
}

TEST_F(ServerTest, TheStateIsAFile) {
  const std::string answer = Client(port()).get("/state.vtu");
  EXPECT_EQ(answer.find("HTTP/1.1 200"), 0u);
  EXPECT_NE(answer.find("<VTKFile"), std::string::npos);
  EXPECT_NE(answer.find("</VTKFile>"), std::string::npos);
}

TEST_F(ServerTest, APortThatIsTakenIsSaid) {
  Options options;
  options.port = port();
  try {
    Server second(options, test::hanging_box());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::io);
    EXPECT_NE(e.remedy().find("--port 0"), std::string::npos);
  }
  options.host = "no address";
  EXPECT_THROW(Server(options, test::hanging_box()), Error);
}

}  // namespace
}  // namespace sinew::server
