// The page before a data set is open: what there is to see, an address, or a file from the disk.
import {openFile, openSource, type Source} from '../core/source';
import {element, showError} from './page';

/** An entry of datasets.json, beside the page. */
interface DataSet {
  readonly name: string;
  /** From datasets.json. */
  readonly url: string;
}

/** Shows the start page, and gives what the user opens there. */
export async function chooseSource(reason: string): Promise<Source> {
  element('start').hidden = false;
  element('start-reason').textContent = reason;
  await listDataSets();
  element<HTMLInputElement>('start-address').focus();
  return new Promise((resolve) => {
    const open = (source: Promise<Source>) =>
      void source.then(
        (opened) => {
          element('start').hidden = true;
          showError('');
          resolve(opened);
        },
        (error: Error) => showError(error.message),
      );
    element('start-form').addEventListener('submit', (event) => {
      event.preventDefault();
      const address = element<HTMLInputElement>('start-address').value;
      location.search = `?tileset=${encodeURIComponent(address)}`;
    });
    const input = element<HTMLInputElement>('start-file');
    input.addEventListener('change', () => input.files?.[0] && open(openFile(input.files[0])));
    onDrop((file) => open(openFile(file)));
  });
}

/** Opens a file dropped anywhere on the page. */
function onDrop(use: (file: File) => void): void {
  const mark = (on: boolean) => (event: DragEvent) => {
    event.preventDefault();
    document.body.classList.toggle('dropping', on);
  };
  addEventListener('dragover', mark(true));
  addEventListener('dragleave', mark(false));
  addEventListener('drop', (event) => {
    mark(false)(event);
    const file = event.dataTransfer?.files[0];
    if (file) use(file);
  });
}

async function listDataSets(): Promise<void> {
  const response = await fetch('./datasets.json').catch(() => undefined);
  const isJson = response?.headers.get('content-type')?.includes('json');
  if (!response?.ok || !isJson) return;
  const sets = (await response.json()) as DataSet[];
  const items = sets.map(({name, url}) => {
    const link = document.createElement('a');
    link.href = `?tileset=${encodeURIComponent(url)}`;
    link.textContent = name;
    const item = document.createElement('li');
    item.append(link);
    return item;
  });
  element('start-list').replaceChildren(...items);
}

/** Opens what the address of the page says; undefined where there is nothing. */
export async function sourceOfPage(parameters: URLSearchParams): Promise<Source | undefined> {
  const asked = parameters.get('tileset');
  const source = await openSource(new URL(asked ?? './tileset.json', location.href).href);
  if (asked) return source;
  const response = await fetch(source.url, {method: 'HEAD'}).catch(() => undefined);
  return response?.ok ? source : undefined;
}
