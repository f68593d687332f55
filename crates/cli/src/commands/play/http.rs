//! HTTP/1.1 (RFC 9112), as much of it as the page needs, and not more than strangers may have.
//!
//! *In:* connections. *Out:* requests for [`Answers`], and what it answers. *Holds:* whoever is not admitted costs little: the head of a
//! request has a largest size and a time limit, its body is not kept, and of the connections that nobody has admitted yet, the oldest one
//! goes when there are too many. So no number of them keeps the page waiting.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The most bytes of the head of a request.
const MAX_HEAD: usize = 16 << 10;
/// The most bytes of its body.
const MAX_BODY: usize = 32 << 20;
/// The most connections that nobody has admitted yet.
const MAX_STRANGERS: usize = 128;
/// How long a head, a body, or the taking of an answer may last.
const PATIENCE: Duration = Duration::from_secs(20);
/// How long an admitted connection may rest: longer than browsers keep one.
const REST: Duration = Duration::from_secs(400);
/// How long the end of a refused request is waited for, so that its sender reads the answer.
const LINGER: Duration = Duration::from_millis(500);
/// How long the listener waits after an error, such as too many open files.
const AGAIN: Duration = Duration::from_millis(20);

/// The head of a request.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Head {
    /// `GET` and so on.
    pub(super) method: String,
    /// The path with its query.
    pub(super) target: String,
    is_old: bool,
    headers: Vec<(String, String)>,
}

impl Head {
    /// The value of a header.
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(own, _)| own.eq_ignore_ascii_case(name)).map(|(_, value)| value.as_str())
    }

    /// The head, without the empty line at its end.
    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.split("\r\n");
        let mut words = lines.next()?.split(' ');
        let (method, target, version) = (words.next()?.to_owned(), words.next()?.to_owned(), words.next()?);
        let is_old = match version {
            "HTTP/1.1" => false,
            "HTTP/1.0" => true,
            _ => return None,
        };
        let header = |line: &str| line.split_once(':').map(|(name, value)| (name.to_owned(), value.trim().to_owned()));
        let headers = lines.map(header).collect::<Option<_>>()?;
        (words.next().is_none() && !method.is_empty()).then_some(Self { method, target, is_old, headers })
    }

    /// How long the body is; otherwise the answer.
    fn body_length(&self) -> Result<usize, Answer> {
        if self.header("Transfer-Encoding").is_some() {
            return Err(Answer::refused(411, "the request does not say how long it is"));
        }
        let length = self.header("Content-Length").unwrap_or("0").parse::<u64>();
        let length = length.map_err(|_| Answer::refused(400, "the length of the request is not a number"))?;
        let length = usize::try_from(length).ok().filter(|length| *length <= MAX_BODY);
        length.ok_or_else(|| Answer::refused(413, "the request is too large"))
    }

    /// Whether other requests may follow on the connection.
    fn keeps_open(&self) -> bool {
        !self.is_old && !self.header("Connection").is_some_and(|value| value.eq_ignore_ascii_case("close"))
    }
}

/// An answer: a status, the type of the body, the body.
#[derive(Debug)]
pub(super) struct Answer {
    pub(super) status: u16,
    pub(super) kind: &'static str,
    pub(super) body: Vec<u8>,
}

impl Answer {
    /// The reason why there is no other one.
    pub(super) fn refused(status: u16, reason: &str) -> Self {
        let body = serde_json::json!({ "error": reason }).to_string().into_bytes();
        Self { status, kind: "application/json", body }
    }
}

/// Whoever answers requests.
pub(super) trait Answers: Send + Sync + 'static {
    /// The headers of every answer.
    const HEADERS: &'static [(&'static str, &'static str)];

    /// Whether a request is answered, by its head alone; otherwise the refusal.
    fn admit(&self, head: &Head) -> Result<(), Answer>;

    /// The answer to a request that was admitted.
    fn answer(&self, head: &Head, body: Vec<u8>) -> Answer;
}

/// Connections that nobody has admitted yet, by the order in which they came.
#[derive(Default)]
struct Strangers(Mutex<(u64, BTreeMap<u64, TcpStream>)>);

impl Strangers {
    fn add(&self, stream: TcpStream) -> u64 {
        let mut strangers = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (count, streams) = &mut *strangers;
        *count += 1;
        streams.insert(*count, stream);
        while streams.len() > MAX_STRANGERS {
            if let Some((_, oldest)) = streams.pop_first() {
                // It may have ended.
                let _ = oldest.shutdown(Shutdown::Both);
            }
        }
        *count
    }

    fn remove(&self, number: u64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).1.remove(&number);
    }
}

/// Answers each connection on a thread of its own, without end.
pub(super) fn serve<A: Answers>(listener: &TcpListener, answers: &Arc<A>) {
    let strangers = Arc::new(Strangers::default());
    loop {
        let Ok((stream, own)) = listener.accept().and_then(|(stream, _)| Ok((stream.try_clone()?, stream))) else {
            std::thread::sleep(AGAIN);
            continue;
        };
        let number = strangers.add(stream);
        let (answers, known) = (Arc::clone(answers), Arc::clone(&strangers));
        let talk = move || {
            // A browser that left does not wait for an answer.
            let _ = talk(own, &*answers, || known.remove(number));
            known.remove(number);
        };
        if std::thread::Builder::new().spawn(talk).is_err() {
            strangers.remove(number);
        }
    }
}

/// Answers the requests of a connection. `admitted` is called with the first one that is admitted.
fn talk<A: Answers>(stream: TcpStream, answers: &A, admitted: impl Fn()) -> std::io::Result<()> {
    // Nothing waits until what was sent before it is acknowledged.
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut connection = Connection { stream, read: Vec::new() };
    let mut patience = PATIENCE;
    loop {
        let head = match connection.head(Instant::now() + patience)? {
            Ok(head) => head,
            Err(refused) => return connection.refuse::<A>(&refused),
        };
        if let Err(refused) = answers.admit(&head) {
            return connection.refuse::<A>(&refused);
        }
        admitted();
        let length = match head.body_length() {
            Ok(length) => length,
            Err(refused) => return connection.refuse::<A>(&refused),
        };
        if head.header("Expect").is_some() {
            connection.stream.write_all(b"HTTP/1.1 100 Continue\r\n\r\n")?;
        }
        let body = connection.body(length, Instant::now() + PATIENCE)?;
        let answer = answers.answer(&head, body);
        let keeps_open = head.keeps_open();
        connection.send::<A>(&answer, keeps_open, head.method != "HEAD")?;
        if !keeps_open {
            return Ok(());
        }
        patience = REST;
    }
}

/// A connection, and what was read of it and is not used yet.
struct Connection {
    stream: TcpStream,
    read: Vec<u8>,
}

impl Connection {
    /// Reads the next bytes until a point in time; no bytes at the end.
    fn more(&mut self, until: Instant) -> std::io::Result<usize> {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        let mut bytes = [0; 16 << 10];
        let n_bytes = self.stream.read(&mut bytes)?;
        self.read.extend(bytes.iter().take(n_bytes));
        Ok(n_bytes)
    }

    /// The next head; otherwise the refusal.
    fn head(&mut self, until: Instant) -> std::io::Result<Result<Head, Answer>> {
        const END: &[u8] = b"\r\n\r\n";
        let mut seen = 0;
        let end = loop {
            let found = self.read.get(seen..).and_then(|new| new.windows(END.len()).position(|part| part == END));
            if let Some(place) = found {
                break seen + place;
            }
            if self.read.len() > MAX_HEAD {
                return Ok(Err(Answer::refused(431, "the head of the request is too large")));
            }
            seen = self.read.len().saturating_sub(END.len() - 1);
            if self.more(until)? == 0 {
                return Err(ErrorKind::UnexpectedEof.into());
            }
        };
        let rest = self.read.split_off(end + END.len());
        let head = std::mem::replace(&mut self.read, rest);
        let head = std::str::from_utf8(head.get(..end).unwrap_or_default()).ok().and_then(Head::parse);
        Ok(head.ok_or_else(|| Answer::refused(400, "it is no request of HTTP/1.1")))
    }

    fn body(&mut self, length: usize, until: Instant) -> std::io::Result<Vec<u8>> {
        while self.read.len() < length {
            if self.more(until)? == 0 {
                return Err(ErrorKind::UnexpectedEof.into());
            }
        }
        let rest = self.read.split_off(length);
        Ok(std::mem::replace(&mut self.read, rest))
    }

    fn send<A: Answers>(&mut self, answer: &Answer, keeps_open: bool, has_body: bool) -> std::io::Result<()> {
        let Answer { status, kind, body } = answer;
        let connection = if keeps_open { "keep-alive" } else { "close" };
        let length = body.len();
        let mut text = format!(
            "HTTP/1.1 {status} {}\r\nConnection: {connection}\r\nContent-Length: {length}\r\nContent-Type: {kind}\r\n",
            if *status == 200 { "OK" } else { "Refused" }
        );
        for (name, value) in A::HEADERS {
            text.extend([name, ": ", value, "\r\n"]);
        }
        let mut bytes = (text + "\r\n").into_bytes();
        bytes.extend(if has_body { body.as_slice() } else { &[] });
        self.stream.write_all(&bytes)
    }

    /// Refuses a request and ends the connection. What still comes is thrown away for a moment: to close at once would take the answer
    /// back.
    fn refuse<A: Answers>(mut self, answer: &Answer) -> std::io::Result<()> {
        self.send::<A>(answer, false, true)?;
        self.stream.shutdown(Shutdown::Write)?;
        let until = Instant::now() + LINGER;
        while self.more(until)? > 0 {
            self.read.clear();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Answer, Answers, Head, MAX_BODY, MAX_HEAD, MAX_STRANGERS, serve};
    use std::io::{Read, Write};
    use std::net::{SocketAddr, TcpListener, TcpStream};
    use std::sync::Arc;

    /// Answers with what it was sent, to those who know the path.
    struct Echo;

    impl Answers for Echo {
        const HEADERS: &'static [(&'static str, &'static str)] = &[("X-Own", "1")];

        fn admit(&self, head: &Head) -> Result<(), Answer> {
            if head.target == "/known" { Ok(()) } else { Err(Answer::refused(403, "no")) }
        }

        fn answer(&self, _: &Head, body: Vec<u8>) -> Answer {
            Answer { status: 200, kind: "text/plain", body }
        }
    }

    fn start() -> SocketAddr {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = listener.local_addr().expect("it has one");
        std::thread::spawn(move || serve(&listener, &Arc::new(Echo)));
        address
    }

    fn sent(address: SocketAddr, text: &str) -> TcpStream {
        let mut stream = TcpStream::connect(address).expect("it listens");
        stream.write_all(text.as_bytes()).expect("it listens");
        stream
    }

    /// All that is answered until the connection ends.
    fn answered(address: SocketAddr, text: &str) -> String {
        let mut all = String::new();
        sent(address, text).read_to_string(&mut all).expect("it answers");
        all
    }

    #[test]
    fn requests_follow_each_other_on_a_connection() {
        let address = start();
        let first = "POST /known HTTP/1.1\r\ncontent-length: 3\r\n\r\none";
        let second = "POST /known HTTP/1.1\r\nContent-Length: 5\r\nConnection: close\r\n\r\nthree";
        let all = answered(address, &[first, second].concat());
        assert_eq!(all.matches("HTTP/1.1 200").count(), 2, "{all}");
        assert!(all.contains("X-Own: 1\r\n\r\none") && all.ends_with("\r\n\r\nthree"), "{all}");
        let continued = "POST /known HTTP/1.0\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\nok";
        assert!(answered(address, continued).starts_with("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200"));
    }

    #[test]
    fn what_is_no_request_is_refused() {
        let address = start();
        let long = format!("GET /known HTTP/1.1\r\nLong: {}", "x".repeat(MAX_HEAD + 1));
        let large = format!("POST /known HTTP/1.1\r\nContent-Length: {}\r\n\r\n", MAX_BODY + 1);
        for (text, status) in [
            (long.as_str(), 431),
            (&large, 413),
            ("POST /known HTTP/1.1\r\nContent-Length: 18446744073709551616\r\n\r\n", 400),
            ("POST /known HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n", 411),
            ("GET /other HTTP/1.1\r\nContent-Length: 18446744073709551615\r\n\r\n", 403),
            ("GET /known HTTP/2.0\r\n\r\n", 400),
            ("GET /known\r\n\r\n", 400),
            ("GET /known HTTP/1.1\r\nno header\r\n\r\n", 400),
            ("\r\n\r\n", 400),
        ] {
            let answer = answered(address, text);
            assert!(answer.starts_with(&format!("HTTP/1.1 {status} ")), "{text:.60}: {answer}");
        }
    }

    #[test]
    fn no_number_of_strangers_keeps_others_waiting() {
        let address = start();
        let promise = "POST /other HTTP/1.1\r\nContent-Length: 1000000\r\n\r\n";
        let promises: Vec<TcpStream> = (0..MAX_STRANGERS).map(|_| sent(address, promise)).collect();
        let silent: Vec<TcpStream> = (0..2 * MAX_STRANGERS).map(|_| sent(address, "GET /known HTTP/1.1\r\n")).collect();
        let answer = answered(address, "GET /known HTTP/1.0\r\n\r\n");
        assert!(answer.starts_with("HTTP/1.1 200 "), "{answer}");
        let mut oldest = silent.into_iter().next().expect("there are some");
        let mut end = Vec::new();
        // It was ended.
        assert!(oldest.read_to_end(&mut end).is_err() || end.is_empty());
        drop(promises);
    }
}
