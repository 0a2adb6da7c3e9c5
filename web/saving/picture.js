/**
 * What the stage shows now, as PNG: as large as it is drawn, without the panels.
 * @param {import('../view/stage.js').Stage} stage
 * @returns {Promise<Blob>}
 */
export function takePicture(stage) {
  stage.draw();  // a drawing is only there to be read until the task that made it ends
  return new Promise((resolve, reject) =>
    stage.renderer.domElement.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('The picture could not be taken.'))), 'image/png'));
}
