#pragma once
// Firefox without a screen, asked through Marionette, its own remote protocol: JSON arrays, each
// behind its length and a colon, on a local socket. https://firefox-source-docs.mozilla.org
// (Marionette, Protocol). It is offline: pages open from files alone.

#include <arpa/inet.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>

namespace momenta {

class Firefox {
 public:
  /// Starts it with a new profile in this folder.
  explicit Firefox(const std::filesystem::path& profile) {
    std::filesystem::create_directories(profile);
    std::ofstream(profile / "user.js")
        << "user_pref(\"marionette.port\", 0);\n"
           "user_pref(\"browser.shell.checkDefaultBrowser\", false);\n"
           "user_pref(\"datareporting.policy.dataSubmissionEnabled\", false);\n";
    child_ = fork();
    if (child_ == 0) {
      const int nowhere = ::open("/dev/null", O_RDWR);
      for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
      execlp("firefox-esr", "firefox-esr", "--headless", "--no-remote", "--marionette",
             "-remote-allow-system-access", "--profile", profile.c_str(), nullptr);
      _exit(127);
    }
    connect_to(port_in(profile / "MarionetteActivePort"));
    receive();  // its greeting
    ask("WebDriver:NewSession", {});
    in_chrome("Services.io.offline = true;");
  }
  ~Firefox() {
    try {
      ask("Marionette:Quit", {{"flags", {"eForceQuit"}}});
    } catch (const std::exception&) {  // it is ended below
    }
    if (socket_ >= 0) close(socket_);
    for (int tenths = 0; waitpid(child_, nullptr, WNOHANG) == 0; ++tenths) {
      if (tenths == 100) kill(child_, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  Firefox(const Firefox&) = delete;
  Firefox& operator=(const Firefox&) = delete;

  void open(const std::filesystem::path& file) {
    in_chrome("Services.console.reset();");
    ask("WebDriver:Navigate", {{"url", "file://" + file.string()}});
  }
  /// What a script in the page returns.
  nlohmann::json in_page(const std::string& script) {
    return ask("WebDriver:ExecuteScript", {{"script", script}, {"args", nlohmann::json::array()}})
        .at("value");
  }
  /// Errors and warnings about files. What a page writes to the console itself is not among them:
  /// that stays with the process of the page.
  std::string console() {
    const auto lines = in_chrome(
        "return Services.console.getMessageArray().map((m) => m.message)"
        ".filter((m) => m.includes('file://'));");
    std::string text;
    for (const auto& line : lines) text += line.get<std::string>() + "\n";
    return text;
  }

 private:
  nlohmann::json in_chrome(const std::string& script) {
    ask("Marionette:SetContext", {{"value", "chrome"}});
    auto value = in_page(script);
    ask("Marionette:SetContext", {{"value", "content"}});
    return value;
  }
  /// [type 0, number, command, what it takes] is answered by [1, number, error, result].
  nlohmann::json ask(const std::string& command, const nlohmann::json& parameters) {
    const std::string text =
        nlohmann::json{0, ++number_, command,
                       parameters.is_null() ? nlohmann::json::object() : parameters}
            .dump();
    const std::string message = std::to_string(text.size()) + ":" + text;
    if (send(socket_, message.data(), message.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(message.size()))
      throw std::runtime_error("Firefox does not listen");
    const auto answer = receive();
    if (!answer.at(2).is_null()) throw std::runtime_error(command + ": " + answer.at(2).dump());
    return answer.at(3);
  }
  nlohmann::json receive() {
    std::size_t colon;
    while ((colon = text_.find(':')) == std::string::npos) more();
    const std::size_t end = colon + 1 + std::stoul(text_.substr(0, colon));
    while (text_.size() < end) more();
    auto message = nlohmann::json::parse(text_.substr(colon + 1, end - colon - 1));
    text_.erase(0, end);
    return message;
  }
  void more() {
    std::array<char, 65536> block{};
    const ssize_t n = recv(socket_, block.data(), block.size(), 0);
    if (n <= 0) throw std::runtime_error("Firefox does not answer");
    text_.append(block.data(), static_cast<std::size_t>(n));
  }
  static int port_in(const std::filesystem::path& file) {
    int port = 0;
    for (int tenths = 0; tenths < 600 && port == 0; ++tenths) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      std::ifstream(file) >> port;
    }
    return port;
  }
  void connect_to(int port) {
    socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const timeval patience{60, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("Firefox did not start");
  }

  pid_t child_ = -1;
  int socket_ = -1, number_ = 0;
  std::string text_;  ///< received, not yet taken
};

}  // namespace momenta
