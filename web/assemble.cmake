# cmake -D PAGE=dir -D SOURCE=dir -D OWN_FILES=... -D CLIENT_FILES=... -D THREE=dir -D UPLOT=dir -P assemble.cmake
# Puts together the directory that is served. Every import in it is relative: the page runs without a bundler and without an
# import map, which a strict content security policy would refuse.
file(REMOVE_RECURSE ${PAGE})
foreach(file ${OWN_FILES})
  cmake_path(GET file PARENT_PATH folder)
  file(COPY ${SOURCE}/${file} DESTINATION ${PAGE}/${folder})
endforeach()
# The folder is the npm package of the element weft-view, too.
file(COPY ${SOURCE}/element/package.json ${SOURCE}/element/README.md DESTINATION ${PAGE})
file(COPY ${CLIENT_FILES} DESTINATION ${PAGE}/protocol)
file(COPY ${THREE}/build/three.module.js ${THREE}/build/three.core.js ${THREE}/LICENSE DESTINATION ${PAGE}/three)
file(COPY ${UPLOT}/dist/uPlot.esm.js ${UPLOT}/dist/uPlot.min.css ${UPLOT}/LICENSE DESTINATION ${PAGE}/uplot)

# This imports the bare name 'three': the only line that is not as its authors wrote it.
file(READ ${THREE}/examples/jsm/controls/OrbitControls.js text)
string(REPLACE "from 'three';" "from './three.module.js';" rewritten "${text}")
if(rewritten STREQUAL text)
  message(FATAL_ERROR "OrbitControls.js no longer imports from 'three': adapt web/assemble.cmake")
endif()
file(WRITE ${PAGE}/three/OrbitControls.js "${rewritten}")
