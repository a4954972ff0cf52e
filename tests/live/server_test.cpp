// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/server/server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "incise/base/error.h"
#include "tests/live/web_client.h"

namespace incise::live {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

class ServerTest : public testing::Test {
  protected:
    ServerTest()
        : server({.host = "127.0.0.1",
                  .port = 0,
                  .files = {{"/", "text/html", "the page"}, {"/app.js", "text/javascript", "code"}},
                  .downloads = {"/file.bin"}}),
          token(server.address().substr(server.address().find("token=") + 6)),
          host("127.0.0.1:" + std::to_string(server.port())) {}

    std::string get(const std::string& target, std::optional<std::string> as_host = {},
                    const std::string& method = "GET") {
        Client client(server.port());
        client.send(method + " " + target + " HTTP/1.1\r\nHost: " + as_host.value_or(host) +
                    "\r\nConnection: close\r\n\r\n");
        return client.read();
    }
    std::string upgrade(const std::string& target, const std::string& origin) const {
        return upgrade_request(target, host, origin);
    }
    /// A page that has connected.
    std::unique_ptr<Client> page() {
        auto client = std::make_unique<Client>(server.port());
        client->send(upgrade("/ws?token=" + token, "http://" + host));
        EXPECT_THAT(client->read(is_head_complete), StartsWith("HTTP/1.1 101"));
        return client;
    }
    /// Collects requests until there are enough.
    std::vector<Request> requests(std::size_t count) {
        std::vector<Request> all;
        const auto until = Clock::now() + patience;
        while (all.size() < count && Clock::now() < until) {
            server.wait_for_request(Clock::now() + milliseconds(100));
            for (Request& request : server.take_requests()) all.push_back(std::move(request));
        }
        return all;
    }

    Server server;
    std::string token, host;
};

TEST_F(ServerTest, GivesThePageToThoseWithTheToken) {
    const std::string page = get("/?token=" + token);
    EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(page, HasSubstr("the page"));
    EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'self'"));
    EXPECT_THAT(page, HasSubstr("nosniff"));
    EXPECT_THAT(get("/app.js?x"), HasSubstr("code"));
    for (const std::string& wrong :
         {std::string("/"), std::string("/?token="), "/?token=" + token.substr(1),
          "/?token=" + std::string(32, '0')}) {
        const std::string refusal = get(wrong);
        EXPECT_THAT(refusal, StartsWith("HTTP/1.1 403")) << wrong;
        EXPECT_THAT(refusal, Not(HasSubstr("the page"))) << wrong;
    }
}

TEST_F(ServerTest, GivesItsAddressAwayOnceOnly) {
    const std::string first = server.address_for_once(), whole = server.address_for_once();
    const auto target = [](const std::string& address) {
        return address.substr(address.find("/?"));
    };
    EXPECT_THAT(whole, Not(HasSubstr(token)));
    EXPECT_THAT(get(target(first)), StartsWith("HTTP/1.1 403")) << "the second took its place";
    EXPECT_THAT(get(target(whole), "evil.example"), StartsWith("HTTP/1.1 421"));
    EXPECT_THAT(get("/?once="), StartsWith("HTTP/1.1 403"));
    const std::string answer = get(target(whole));
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 303"));
    EXPECT_THAT(answer, HasSubstr("Location: /?token=" + token + "\r\n"));
    EXPECT_THAT(get(target(whole)), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(get("/?once="), StartsWith("HTTP/1.1 403"));
}

TEST_F(ServerTest, RefusesOtherPathsAndMethods) {
    EXPECT_THAT(get("/../etc/passwd"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(get("/%2e%2e/app.js"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(get("/app.js", {}, "POST"), StartsWith("HTTP/1.1 405"));
    EXPECT_THAT(get("/" + std::string(20000, 'a')), Not(HasSubstr("200 OK")));
    EXPECT_THAT(get("/app.js", {}, "\xff\x01 rubbish"), Not(HasSubstr("200 OK")));
}

TEST_F(ServerTest, AnswersToTheNamesOfThisMachineOnly) {
    const auto answer = [&](const std::string& as_host) {
        return get("/?token=" + token, as_host).substr(0, 12);
    };
    // A forwarded port is another one here and there.
    for (const std::string& own :
         {host, std::string("localhost:9999"), std::string("localhost"), std::string("[::1]:80"),
          std::string("[::1]"), std::string("127.0.0.1:65535"), std::string("LOCALHOST:8080"),
          std::string("LocalHost")})
        EXPECT_EQ(answer(own), "HTTP/1.1 200") << own;
    for (const std::string machine : {"127.0.0.1", "localhost", "[::1]"})
        for (const std::string rest : {":80.evil.example",
                                       ":80:evil.example",
                                       ".evil.example:80",
                                       ".evil.example",
                                       ".",
                                       ".:80",
                                       ":",
                                       ":80.",
                                       ":8o",
                                       ":+80",
                                       ":-80",
                                       ":65536",
                                       ":80 evil.example",
                                       ":80/",
                                       "@evil.example",
                                       ":80@evil.example:80",
                                       "]",
                                       "]:80",
                                       "[",
                                       "%lo:80",
                                       "\t.evil"})
            EXPECT_EQ(answer(machine + rest), "HTTP/1.1 421") << machine << rest;
    for (const std::string other : {"",
                                    ":80",
                                    "evil.example",
                                    "evil.example:80",
                                    "user@127.0.0.1:80",
                                    "@127.0.0.1",
                                    "[",
                                    "[]",
                                    "]",
                                    "[::1",
                                    "::1",
                                    "::1:80",
                                    "[127.0.0.1]:80",
                                    "[[::1]]:80",
                                    "[::1%lo]:80",
                                    "[::2]:80",
                                    "127.0.0.2:80",
                                    "0.0.0.0:80",
                                    "127.1:80",
                                    "localhos",
                                    "localhostt",
                                    "LOCALHOST.EVIL.EXAMPLE:80",
                                    "1OCALHOST:80",
                                    "2130706433:80"})
        EXPECT_EQ(answer(other), "HTTP/1.1 421") << other;
    EXPECT_EQ(answer("localhost\r\nHost: evil.example"), "HTTP/1.1 421");
    EXPECT_EQ(answer("evil.example\r\nHost: localhost"), "HTTP/1.1 421");
}

TEST_F(ServerTest, ThatListensForAllReadsHostsStrictlyToo) {
    const Server open({.host = "0.0.0.0", .port = 0, .files = {{"/", "text/html", "the page"}}});
    const auto answer = [&](const std::string& as_host) {
        Client client(open.port());
        client.send("GET / HTTP/1.1\r\nHost: " + as_host + "\r\nConnection: close\r\n\r\n");
        return client.read().substr(0, 12);
    };
    for (const std::string any : {"box.example", "box.example:8080", "192.168.0.7", "[fe80::1]:80"})
        EXPECT_EQ(answer(any), "HTTP/1.1 403") << any;  // it asks for the token
    for (const std::string wrong : {"", ":80", "box:80.evil", "me@box:80", "[fe80::1", "box:"})
        EXPECT_EQ(answer(wrong), "HTTP/1.1 421") << wrong;
}

TEST_F(ServerTest, LetsOnlyItsOwnPageConnect) {
    const auto answer = [&](const std::string& target, const std::string& origin) {
        Client client(server.port());
        client.send(upgrade(target, origin));
        return client.read(is_head_complete);
    };
    const std::string own = "/ws?token=" + token, origin = "http://" + host;
    EXPECT_THAT(answer(own, origin), StartsWith("HTTP/1.1 101"));
    EXPECT_THAT(answer(own, "http://evil.example"), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(answer(own, ""), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(answer("/ws?token=wrong", origin), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(answer("/elsewhere?token=" + token, origin), StartsWith("HTTP/1.1 404"));
}

TEST_F(ServerTest, PassesMessagesInTheirOrder) {
    server.greet_with("welcome");
    const auto client = page();
    client->send(frame("one") + frame("two"));
    const auto all = requests(3);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].kind, Request::Kind::opened);
    EXPECT_EQ(all[1].text, "one");
    EXPECT_EQ(all[2].text, "two");
    EXPECT_EQ(all[2].page, all[0].page);
    server.send(all[0].page, "for you");
    server.send_to_all("for all");
    EXPECT_THAT(client->read([](const std::string& s) { return s.ends_with("for all"); }),
                testing::ContainsRegex("welcome.*for you.*for all"));
}

TEST_F(ServerTest, SendsTheTopologyOnlyToThoseThatLackIt) {
    const auto picture = [](std::uint64_t version, const std::string& moving) {
        auto made = std::make_shared<Picture>();
        made->topology_version = version;
        made->head_with_topology = "HEAD+";
        made->head_without_topology = "HEAD-";
        made->topology = std::make_shared<const std::string>("TOPOLOGY");
        made->moving = moving;
        made->state = "state of " + moving;
        return made;
    };
    const auto show_and_read = [&](Client& client, std::shared_ptr<const Picture> shown) {
        const std::string end = shown->state;
        server.show(std::move(shown));
        const std::size_t before = client.read([](const std::string&) { return true; }).size();
        return client.read([&](const std::string& s) { return s.ends_with(end); }).substr(before);
    };
    const auto first = page();
    EXPECT_THAT(show_and_read(*first, picture(1, "a")), HasSubstr("HEAD+TOPOLOGYa"));
    EXPECT_THAT(show_and_read(*first, picture(1, "b")), HasSubstr("HEAD-b"));
    EXPECT_THAT(show_and_read(*first, picture(2, "c")), HasSubstr("HEAD+TOPOLOGYc"));
    const auto second = page();  // gets the last picture at once
    EXPECT_THAT(second->read([](const std::string& s) { return s.ends_with("state of c"); }),
                HasSubstr("HEAD+TOPOLOGYc"));
}

TEST_F(ServerTest, DisconnectsThoseThatBreakRules) {
    for (const std::string& bytes :
         {frame(std::string(70000, 'x')), frame("\xff\xfe\xfd"), frame("x", 0xf1),
          std::string("\x81\x05hello"), std::string(300, '\x7f')}) {
        const auto client = page();
        client->send(bytes);
        client->read();  // ends, as the server closes
    }
    const auto all = requests(10);
    EXPECT_EQ(std::ranges::count(all, Request::Kind::opened, &Request::kind), 5);
    EXPECT_EQ(std::ranges::count(all, Request::Kind::closed, &Request::kind), 5);
}

TEST_F(ServerTest, HoldsBackAPageThatFloods) {
    const auto flooding = page(), calm = page();
    std::string flood;
    for (int i = 0; i < 5000; ++i) flood += frame(std::to_string(i));
    std::jthread sender([&] { flooding->send(flood); });
    calm->send(frame("calm"));
    std::size_t most = 0, num_texts = 0;
    bool is_calm_heard = false;
    const auto until = Clock::now() + patience;
    while (num_texts < 5001 && Clock::now() < until) {
        std::this_thread::sleep_for(milliseconds(1));  // a tick
        const auto taken = server.take_requests();
        most = std::max(most, taken.size());
        for (const Request& request : taken) {
            if (request.kind != Request::Kind::text) continue;
            if (request.text == "calm") is_calm_heard = true;
            ++num_texts;
        }
    }
    EXPECT_EQ(num_texts, 5001u);  // none is lost
    EXPECT_LE(most, 200u);
    EXPECT_TRUE(is_calm_heard);
}

TEST_F(ServerTest, DoesNotWaitForAPageThatReadsNothing) {
    const auto deaf = page(), good = page();
    // More than what the system keeps for a page that does not read.
    for (int i = 0; i < 24; ++i) {
        auto big = std::make_shared<Picture>();
        big->topology_version = 1;
        big->topology = std::make_shared<const std::string>();
        big->moving = std::string(1 << 20, 'm');
        big->state = "picture " + std::to_string(i) + ".";
        server.show(big);
        EXPECT_TRUE(good->read([&](const std::string& s) { return s.ends_with(big->state); })
                        .ends_with(big->state));
    }
    // Texts must not be lost: the deaf page is disconnected, and the good one is not.
    for (int i = 0; i < 300; ++i) {
        const std::string text = "text " + std::to_string(i) + ".";
        server.send_to_all(text);
        EXPECT_TRUE(
            good->read([&](const std::string& s) { return s.ends_with(text); }).ends_with(text));
    }
    const auto all = requests(3);
    EXPECT_EQ(std::ranges::count(all, Request::Kind::closed, &Request::kind), 1);
}

TEST_F(ServerTest, AnswersDownloadsOfThoseWithTheToken) {
    EXPECT_THAT(get("/file.bin"), StartsWith("HTTP/1.1 403"));
    std::string answer;
    std::jthread client([&] { answer = get("/file.bin?token=" + token); });
    const auto all = requests(1);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].text, "/file.bin");
    server.answer(all[0].page, std::string("\0\1\2", 3), "application/octet-stream", "a.bin");
    client.join();
    EXPECT_THAT(answer, HasSubstr("filename=\"a.bin\""));
    EXPECT_TRUE(answer.ends_with(std::string("\0\1\2", 3)));
}

TEST_F(ServerTest, RefusesMorePagesThanItServes) {
    std::vector<std::unique_ptr<Client>> pages;
    for (std::size_t i = 0; i < Server::most_pages; ++i) pages.push_back(page());
    requests(Server::most_pages);
    Client further(server.port());
    further.send(upgrade("/ws?token=" + token, "http://" + host));
    EXPECT_THAT(further.read(is_head_complete), StartsWith("HTTP/1.1 503"));
}

TEST_F(ServerTest, LetsNobodyKeepOthersOutWithoutTheToken) {
    const auto own = page();
    std::vector<std::unique_ptr<Client>> idle;
    for (int i = 0; i < 100; ++i) idle.push_back(std::make_unique<Client>(server.port()));
    EXPECT_THAT(get("/?token=" + token), HasSubstr("the page"));
    own->send(frame("still here"));
    const auto all = requests(2);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[1].text, "still here");
}

TEST_F(ServerTest, EndsWhilePagesAreOpen) {
    // A page that talks has no end of its own: a server that waits for one never ends.
    auto other = std::make_unique<Server>(ServerOptions{.port = 0});
    Client idle(other->port()), talking(other->port());
    idle.send("GET / HT");
    const std::string address = other->address(),
                      as_host = address.substr(7, address.find("/?") - 7);
    talking.send(upgrade_request("/ws" + address.substr(address.find("?token=")), as_host,
                                 "http://" + as_host));
    EXPECT_THAT(talking.read(is_head_complete), StartsWith("HTTP/1.1 101"));
    std::jthread page([&](std::stop_token has_ended) {
        while (!has_ended.stop_requested()) {
            talking.send(frame("still here"));
            std::this_thread::sleep_for(milliseconds(10));
        }
    });
    other.reset();
}

TEST_F(ServerTest, SaysWhyItCannotListen) {
    try {
        Server second({.host = "127.0.0.1", .port = server.port()});
        FAIL();
    } catch (const OutputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("cannot be listened on"));
        EXPECT_THAT(error.what(), HasSubstr("--port"));
    }
    EXPECT_THROW(Server({.host = "nonsense", .port = 0}), InputError);
}

}  // namespace
}  // namespace incise::live
