"""A browser driven over the W3C WebDriver protocol, with the standard library only."""
import base64
import json
import re
import shutil
import subprocess
import tempfile
import urllib.error
import urllib.request

ELEMENT = 'element-6066-11e4-a52e-4f735466cecf'
KEYS = {'left': '\ue012', 'up': '\ue013', 'right': '\ue014', 'down': '\ue015', 'shift': '\ue008',
        'enter': '\ue007', 'tab': '\ue004'}


class Failure(Exception):
    pass


def missing():
    """What is not installed; '' when nothing is missing."""
    if not shutil.which('chromedriver'):
        return 'chromedriver is not installed (Debian: chromium-driver)'
    if not (shutil.which('chromium') or shutil.which('google-chrome')):
        return 'chromium is not installed'
    return ''


class Browser:
    """Headless Chromium with a profile of its own."""

    def __init__(self):
        self.profile = tempfile.mkdtemp(prefix='penumbra-browser-')
        self.driver = subprocess.Popen(['chromedriver', '--port=0'], stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL, text=True)
        self.base = ''
        try:
            for line in self.driver.stdout:
                found = re.search(r'started successfully on port (\d+)', line)
                if found:
                    self.base = 'http://127.0.0.1:' + found[1]
                    break
            if not self.base:
                raise Failure('chromedriver did not start')
            self.base += '/session/' + self._open()
        except BaseException:
            self.close()
            raise

    def _open(self):
        binary = shutil.which('chromium') or shutil.which('google-chrome')
        arguments = ['--headless=new', '--no-sandbox', '--disable-gpu', '--no-first-run',
                     '--disable-background-networking', '--disable-dev-shm-usage',
                     '--window-size=1280,900', '--user-data-dir=' + self.profile]
        wanted = {'browserName': 'chrome', 'goog:chromeOptions': {
                      'binary': binary, 'args': arguments, 'perfLoggingPrefs': {
                          'enableNetwork': True}},
                  'unhandledPromptBehavior': 'ignore',
                  'goog:loggingPrefs': {'browser': 'ALL', 'performance': 'ALL'}}
        value = self._call('POST', '/session', {'capabilities': {'alwaysMatch': wanted}})
        return value['sessionId']

    def close(self):
        try:
            if '/session/' in self.base:
                self._call('DELETE', '')
        except Failure:
            pass
        self.driver.terminate()
        self.driver.wait(20)
        self.driver.stdout.close()
        shutil.rmtree(self.profile, ignore_errors=True)

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, method=method,
                                         headers={'Content-Type': 'application/json'})
        # No proxy: the driver is on this machine.
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request, timeout=120) as answer:
                return json.load(answer)['value']
        except urllib.error.HTTPError as error:
            value = json.load(error)['value']
            raise Failure(value['error'] + ': ' + value['message'].split('\n')[0]) from None
        except OSError as error:
            raise Failure(str(error)) from None

    def go(self, url):
        self._call('POST', '/url', {'url': url})

    def run(self, script, *arguments):
        return self._call('POST', '/execute/sync', {'script': script, 'args': list(arguments)})

    def run_async(self, script, *arguments):
        return self._call('POST', '/execute/async', {'script': script, 'args': list(arguments)})

    def cdp(self, command, **parameters):
        return self._call('POST', '/goog/cdp/execute', {'cmd': command, 'params': parameters})

    def find(self, selector):
        return self._call('POST', '/element', {'using': 'css selector', 'value': selector})

    def click(self, selector):
        self._call('POST', '/element/%s/click' % self.find(selector)[ELEMENT], {})

    def write(self, selector, text):
        self._call('POST', '/element/%s/value' % self.find(selector)[ELEMENT], {'text': text})

    def clear(self, selector):
        self._call('POST', '/element/%s/clear' % self.find(selector)[ELEMENT], {})

    def text(self, selector):
        return self._call('GET', '/element/%s/text' % self.find(selector)[ELEMENT])

    def has_dialog(self):
        try:
            self._call('GET', '/alert/text')
            return True
        except Failure as error:
            if 'no such alert' in str(error):
                return False
            raise

    def keys(self, *names):
        """Presses keys one after the other; 'shift+left' holds one."""
        actions = []
        for name in names:
            held = [KEYS.get(key, key) for key in re.findall(r'[^+]+|^\+$', name)]
            actions += [{'type': 'keyDown', 'value': key} for key in held]
            actions += [{'type': 'keyUp', 'value': key} for key in reversed(held)]
        self._act({'type': 'key', 'id': 'keyboard', 'actions': actions})

    def pointer(self, *steps, kind='mouse'):
        """Steps: (x, y) moves within the viewport; 'down' and 'up' press and release."""
        actions = []
        for step in steps:
            if isinstance(step, tuple):
                actions.append({'type': 'pointerMove', 'duration': 20, 'origin': 'viewport',
                                'x': round(step[0]), 'y': round(step[1])})
            else:
                actions.append({'type': 'pointer' + step.capitalize(), 'button': 0})
        self._act({'type': 'pointer', 'id': kind, 'parameters': {'pointerType': kind},
                   'actions': actions})

    def fingers(self, first, second):
        """Two fingers, each from a place to another."""
        def finger(name, places):
            (x, y), (u, v) = places
            move = {'type': 'pointerMove', 'origin': 'viewport'}
            return {'type': 'pointer', 'id': name, 'parameters': {'pointerType': 'touch'},
                    'actions': [dict(move, x=round(x), y=round(y), duration=0),
                                {'type': 'pointerDown', 'button': 0},
                                dict(move, x=round(u), y=round(v), duration=150),
                                {'type': 'pointerUp', 'button': 0}]}
        self._act(finger('thumb', first), finger('index', second))

    def wheel(self, x, y, delta):
        self._act({'type': 'wheel', 'id': 'wheel', 'actions': [
            {'type': 'scroll', 'x': round(x), 'y': round(y), 'deltaX': 0, 'deltaY': delta,
             'origin': 'viewport', 'duration': 0}]})

    def _act(self, *sources):
        self._call('POST', '/actions', {'actions': list(sources)})
        self._call('DELETE', '/actions')

    def log(self, kind):
        return self._call('POST', '/se/log', {'type': kind})

    def size(self, width, height, scale=1):
        self.cdp('Emulation.setDeviceMetricsOverride', width=width, height=height,
                 deviceScaleFactor=scale, mobile=width < 500)

    def media(self, scheme='light', motion='no-preference'):
        self.cdp('Emulation.setEmulatedMedia', features=[
            {'name': 'prefers-color-scheme', 'value': scheme},
            {'name': 'prefers-reduced-motion', 'value': motion}])

    def screenshot(self, file):
        """The whole page, however long it is."""
        page = self.cdp('Page.captureScreenshot', captureBeyondViewport=True)
        with open(file, 'wb') as out:
            out.write(base64.b64decode(page['data']))
